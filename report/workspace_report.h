// The answer to a workspace question, as a file and for a terminal.
#pragma once

#include <string>

#include "studies/workspace/workspace_study.h"

namespace understudy::report {

/// workspace.json (docs/workspace.md).
std::string workspace_json(const studies::WorkspaceStudy& study);
/// A few lines for a terminal.
std::string workspace_table(const studies::WorkspaceStudy& study);

}  // namespace understudy::report

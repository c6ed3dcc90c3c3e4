#pragma once

#include "cli/command.h"

namespace understudy::cli {

void add_export_video(CLI::App& command, Action& action);

}  // namespace understudy::cli

// Scenarios of a study: a command in place of a rehearsal.
#pragma once

#include <filesystem>

#include "regression/scenario.h"

namespace understudy::cli {

/// Runs the scenario's command with `--out FOLDER` in a process of its own and gives every figure of the JSON
/// files that it writes there, under the file's name: "workspace.reachable.fraction"; and `exit_status`, 0
/// or 1. A word that is a file beside the scenario stands for that file. Throws InputError for a command that
/// scenarios may not run and for one that ends with status 2, MachineError for one that fails otherwise.
regression::Metrics command_figures(const regression::Scenario& scenario,
                                    const std::filesystem::path& folder);

}  // namespace understudy::cli

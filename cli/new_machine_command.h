// The sub-command new-machine.
#pragma once

#include "cli/command.h"

namespace understudy::cli {

void add_new_machine(CLI::App& app, Action& action);

}  // namespace understudy::cli

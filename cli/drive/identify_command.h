// `understudy identify`, in every build.
#pragma once

#include "cli/command.h"

namespace understudy::cli {

void add_identify(CLI::App& app, Action& action);

}  // namespace understudy::cli

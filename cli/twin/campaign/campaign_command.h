// `understudy campaign`.
#pragma once

#include "cli/command.h"

namespace understudy::cli {

void add_campaign(CLI::App& app, Action& action);

}  // namespace understudy::cli

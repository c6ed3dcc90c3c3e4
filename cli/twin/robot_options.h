// Options of `understudy rehearse` that say how a robot's program is read.
#pragma once

#include <CLI/App.hpp>

#include "rehearsal/request/request.h"

namespace understudy::cli {

/// `robot` must outlive `command`.
void add_robot_options(CLI::App& command, rehearsal::RobotProgramRequest& robot);

}  // namespace understudy::cli

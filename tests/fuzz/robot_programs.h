// The ways in which programs of robots are read, and what is asked of one that was accepted.
#pragma once

#include <vector>

#include "toolpath/robot/robot_program.h"

namespace understudy::fuzz {

/// A bead along the path; a flow, with unknown statements passed over and the signal guessed; every move
/// printing.
std::vector<toolpath::RobotOptions> robot_readings(std::vector<toolpath::UnknownWordCount>& unknown,
                                                   toolpath::RobotFacts& facts);

/// Throws Finding for figures that are not finite, or poses that turn nothing.
void check_robot_program(const toolpath::Program& program, const toolpath::RobotOptions& options);

}  // namespace understudy::fuzz

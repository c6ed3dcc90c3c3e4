// The ways in which programs of robots are read, and what is asked of one that was accepted.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "toolpath/robot/robot_program.h"

namespace understudy::fuzz {

/// Has an input of `bytes`, called `file`, read in three ways: a bead along the path; a flow, with unknown
/// statements passed over and the signal guessed; every move printing. Throws Finding as accepts() does, and
/// for figures that are not finite, or poses that turn nothing.
void check_robot_reader(std::size_t bytes, const std::string& file,
                        const std::function<toolpath::Program(const toolpath::RobotOptions&)>& read);

}  // namespace understudy::fuzz

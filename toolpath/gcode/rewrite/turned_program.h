// A program that is turned as a whole about the world's vertical through its origin.
#pragma once

#include <string>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {

/// The path turns by `turn` about z of W through `offset_W`, and the tool's axis with it. The tool itself
/// does not: it keeps the turn about its own axis that the program states, plus `spin`. So a pose R of the
/// program becomes Rz(turn) R Rz(spin - turn); home stays where it is. [rad]
struct ProgramTurn {
  double turn = 0, spin = 0;
};

/// X_WT of a pose of the program at X_UT in the frame U that turns with it, whose origin is at `origin_W`.
Pose turned_pose(const Pose& X_UT, const Vec3& origin_W, const ProgramTurn& by);

/// As parse_gcode() reads it, and turned. What the program leaves to the present position, such as the X of
/// the first move after G28, is that position as before. Throws InputError as parse_gcode() does, and for a
/// turn of a program that states rotary words.
Program parse_turned_gcode(const std::string& text, const std::string& file, const GcodeOptions& options,
                           const ProgramTurn& by);

}  // namespace understudy::toolpath

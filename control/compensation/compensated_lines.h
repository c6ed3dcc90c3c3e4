// Where the lines of a program have to go, so that a controller with nominal kinematics puts the tool where
// the program asks for it.
#pragma once

#include <functional>
#include <vector>

#include "machine/description.h"
#include "toolpath/gcode/rewrite/gcode_rewrite.h"
#include "toolpath/program.h"

namespace understudy::control {

/// What is added to the pose that is asked for at a share of a step's way: translation of the tip [m] and
/// rotation vector [rad], both in W.
using Correction = std::function<Twist(std::size_t step, double fraction)>;

struct CompensationTask {
  const machine::MachineDescription& nominal;  ///< what the controller reckons with
  const machine::MachineDescription& known;    ///< the same machine, calibrated
  Correction correction = {};                  ///< empty: none
  /// [m], by which the tip may leave the compensated way between two points of a line; 2 um is a fifth of
  /// what a calibration leaves.
  double tolerance = 2e-6;
};

/// Pieces of the `lines` of a program that say where the tool goes (toolpath::lines_that_place); other lines
/// stay. The way is looked at every 0.2 mm and every degree, and no piece bends by more than what the planner
/// takes at a corner without braking. Throws InputError with the line of a pose that one of the two machines
/// does not reach.
toolpath::MovedLines compensated_lines(const toolpath::Program& program, const std::vector<int>& lines,
                                       const CompensationTask& task);

}  // namespace understudy::control

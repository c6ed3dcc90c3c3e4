// A helix of beads about the middle of a machine's work space, for prints on controllers of others.
#pragma once

#include <cmath>

#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::drivers {

struct Helix {
  int moves = 0, moves_in_a_piece = 1;  ///< behind each piece the fan changes, and the machine comes to rest
  double radius = 0, turn = 0;          ///< [m]; [rad] a move
  double tilt = 0, spin = 0;            ///< [rad], of the tool: towards where it goes, and about its axis
  double feed = 0, filament = 0;        ///< [m/s]; [m] a move
};

inline toolpath::Program program_of(const Helix& helix, const machine::MachineDescription& machine) {
  toolpath::Program program;
  program.file = "helix.gcode";
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  for (int i = 0; i <= helix.moves; ++i) {
    const double c = std::cos(helix.turn * i), s = std::sin(helix.turn * i);
    toolpath::Step step;
    step.kind = i == 0 ? toolpath::StepKind::travel : toolpath::StepKind::print;
    step.X_WT = X_WT_home;
    step.X_WT.translation() += Vec3(helix.radius * c, helix.radius * s, -10e-6 * i);
    step.X_WT.linear() = exp_rotation(Vec3(-helix.tilt * s, helix.tilt * c, helix.spin)) * X_WT_home.linear();
    step.feed = helix.feed;
    step.filament = i == 0 ? 0 : helix.filament;
    step.line = i + 1;
    program.steps.push_back(step);
    if (i % helix.moves_in_a_piece != 0) continue;
    toolpath::Step fan;
    fan.kind = toolpath::StepKind::fan;
    fan.fan = i / helix.moves_in_a_piece % 2 == 0 ? 0.5 : 1;
    fan.line = i + 1;
    program.steps.push_back(fan);
  }
  return program;
}

}  // namespace understudy::drivers

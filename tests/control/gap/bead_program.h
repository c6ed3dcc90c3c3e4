// A small program over a flat part under the home tip: heat, S', S, 10 mm of bead, up.
#pragma once

#include "control/print.h"
#include "tests/control/gap/gap_rig.h"
#include "tests/shipped_hexapod.h"

namespace understudy::control {

constexpr double kTable = 0.05;   // [m], height of the surface under the home tip
constexpr double kGap = 0.13e-3;  // [m], programmed

inline toolpath::Step step_to(toolpath::StepKind kind, const Vec3& p, double feed, int line,
                              double filament = 0) {
  toolpath::Step s;
  s.kind = kind;
  s.X_WT = make_pose(Quat::Identity(), p);
  s.feed = feed;
  s.line = line;
  s.filament = filament;
  return s;
}

/// Heat, S', S, 10 mm of bead along x, up.
inline toolpath::Program bead_program() {
  toolpath::Program program;
  program.file = "bead.gcode";
  toolpath::Step heat, fan, end;
  heat.kind = toolpath::StepKind::temperature;
  heat.temperature = 483;
  heat.line = 1;
  fan.kind = toolpath::StepKind::fan;
  fan.fan = 0.5;
  fan.line = 2;
  end.kind = toolpath::StepKind::end;
  end.line = 9;
  const double z = kTable + kGap;
  program.steps = {heat,
                   fan,
                   step_to(toolpath::StepKind::travel, {0, 0, z + 5e-3}, 0, 3),
                   step_to(toolpath::StepKind::travel, {0, 0, z + 2e-3}, 0, 4),
                   step_to(toolpath::StepKind::move, {0, 0, z}, 2e-3, 5),
                   step_to(toolpath::StepKind::print, {5e-3, 0, z}, 5e-3, 6, 1e-4),
                   step_to(toolpath::StepKind::print, {10e-3, 0, z}, 5e-3, 7, 1e-4),
                   step_to(toolpath::StepKind::move, {10e-3, 0, z + 5e-3}, 5e-3, 8, -1e-3),
                   end};
  return program;
}

inline DotWorld flat_part() { return plane_through(Vec3(0, 0, kTable), Vec3::UnitZ()); }
inline GapRigOptions low_by(double error) { return {flat_part(), Vec3(0, 0, error), Vec3::Zero(), 0.35, 1}; }

inline PrintOptions without_gap_control() {
  PrintOptions options;
  options.gap_control = GapControl::off;
  return options;
}

}  // namespace understudy::control

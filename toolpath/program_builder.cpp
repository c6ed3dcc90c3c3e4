#include "toolpath/program_builder.h"

#include "toolpath/bead.h"

namespace understudy::toolpath {

ProgramBuilder::ProgramBuilder(double filament_diameter) : filament_area_(strand_area(filament_diameter)) {}

void ProgramBuilder::begin(const Pose& first, double temperature, double fan) {
  // Steps that do not move leave the tool where the program will put it first.
  if (temperature > 0) {
    Step& heat = add(StepKind::temperature, first);
    heat.temperature = temperature;
    heat.wait = true;
  }
  add(StepKind::fan, first).fan = fan;
}

void ProgramBuilder::travel(const Pose& X_WT) { add(StepKind::travel, X_WT); }

void ProgramBuilder::move(const Pose& X_WT, double feed) { add(StepKind::move, X_WT).feed = feed; }

void ProgramBuilder::print(const Pose& X_WT, double feed, double volume) {
  Step& step = add(StepKind::print, X_WT);
  step.feed = feed;
  step.filament = volume / filament_area_;
}

void ProgramBuilder::dwell(double seconds) {
  if (seconds > 0) add(StepKind::dwell, X_WT_).duration = seconds;
}

Step& ProgramBuilder::add(StepKind kind, const Pose& X_WT) {
  Step step;
  step.kind = kind;
  step.X_WT = X_WT_ = X_WT;
  program_.steps.push_back(step);
  return program_.steps.back();
}

Pose tool_at(const Vec3& p, const Vec3& axis, double height) {
  return make_pose(shortest_arc_from_z(axis), p + height * axis);
}

}  // namespace understudy::toolpath

#include "control/approach.h"

#include <cmath>

namespace understudy::control {

using toolpath::Program;
using toolpath::StepKind;

Pose pose_before(const Program& program, std::size_t index, const Pose& start) {
  for (std::size_t i = index; i-- > 0;)
    if (toolpath::moves(program.steps[i])) return program.steps[i].X_WT;
  return start;
}

bool is_approach(const Program& program, std::size_t index) {
  const auto& step = program.steps[index];
  if (step.kind != StepKind::move || index == 0) return false;
  const Pose from = pose_before(program, index, step.X_WT);
  const Vec3 way = step.X_WT.translation() - from.translation();
  const double length = way.norm();
  if (!(length > 0) || length > kApproachLengthMax) return false;
  if (-way.dot(tool_axis(step.X_WT)) < length * std::cos(kApproachAngleMax)) return false;
  if (angle_between(from.linear(), step.X_WT.linear()) > kApproachAngleMax) return false;
  for (std::size_t i = index + 1; i < program.steps.size(); ++i)
    if (toolpath::moves(program.steps[i])) return program.steps[i].kind == StepKind::print;
  return false;
}

}  // namespace understudy::control

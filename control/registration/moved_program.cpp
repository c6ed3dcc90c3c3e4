#include "control/registration/moved_program.h"

namespace understudy::control {

toolpath::Program moved_program(const toolpath::Program& program, const Pose& X_W) {
  toolpath::Program moved = program;
  bool at_home = true;
  for (toolpath::Step& step : moved.steps) {
    if (toolpath::moves(step)) at_home = step.kind == toolpath::StepKind::home;
    if (at_home) continue;
    const Mat3 turned = step.rotary ? Mat3(step.X_WT.linear()) : Mat3(X_W.linear() * step.X_WT.linear());
    step.X_WT.translation() = X_W * step.X_WT.translation();
    step.X_WT.linear() = turned;
  }
  return moved;
}

std::shared_ptr<const geometry::Mesh> moved_part(const geometry::Mesh& part, const Pose& X_W) {
  std::vector<Vec3> vertices = part.vertices();
  for (Vec3& vertex : vertices) vertex = X_W * vertex;
  return std::make_shared<geometry::Mesh>(std::move(vertices), part.triangles());
}

}  // namespace understudy::control

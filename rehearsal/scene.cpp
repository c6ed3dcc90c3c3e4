#include "rehearsal/scene.h"

#include "sim/collision/machine_bodies.h"

namespace understudy::rehearsal {

Scene machine_scene(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                    const sim::Configuration& configuration) {
  Scene scene;
  scene.X_WT = configuration.X_WT;
  scene.bodies = sim::machine_bodies(machine, as_built, configuration);
  // The base has no part in collisions: a ring of joints tells where the struts hang.
  if (!machine.is_chain())
    for (const Vec3& p_BB : as_built.hexapod.base_joint) {
      geometry::Shape joint{"base joint", geometry::Sphere{1.6 * machine.hexapod().strut_radius}};
      joint.X_FS.translation() = machine.X_WB * p_BB;
      scene.bodies.push_back(joint);
    }
  scene.table = machine.table;
  return scene;
}

std::vector<std::vector<Vec3>> printed_path(const toolpath::Program& program) {
  std::vector<std::vector<Vec3>> path;
  Vec3 previous = Vec3::Zero();
  bool printing = false;
  for (const auto& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    const Vec3 tip = step.X_WT.translation();
    if (step.kind == toolpath::StepKind::print) {
      if (!printing) path.push_back({previous});
      path.back().push_back(tip);
    }
    printing = step.kind == toolpath::StepKind::print;
    previous = tip;
  }
  return path;
}

}  // namespace understudy::rehearsal

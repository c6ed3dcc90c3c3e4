#include "rehearsal/scene.h"

#include <algorithm>
#include <cmath>

#include "sim/collision/chain_bodies.h"
#include "sim/collision/machine_bodies.h"

namespace understudy::rehearsal {
namespace {

/// The base has no part in collisions: joints where the struts hang, and rods from each to its neighbours.
void add_base(const machine::MachineDescription& machine, const kinematics::PerStrut<Vec3>& joints_B,
              std::vector<geometry::Shape>& bodies) {
  std::vector<Vec3> ring(joints_B.begin(), joints_B.end());
  std::sort(ring.begin(), ring.end(),
            [](const Vec3& a, const Vec3& b) { return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x()); });
  const double radius = machine.hexapod().strut_radius;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 here = machine.X_WB * ring[i], next = machine.X_WB * ring[(i + 1) % ring.size()];
    geometry::Shape joint{"base joint", geometry::Sphere{1.6 * radius}};
    joint.X_FS.translation() = here;
    bodies.push_back(joint);
    bodies.push_back(geometry::capsule_between("base frame", here, next, 0.9 * radius));
  }
}

}  // namespace

Scene machine_scene(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                    const sim::Configuration& configuration) {
  Scene scene;
  scene.X_WT = configuration.X_WT;
  scene.bodies = sim::machine_bodies(machine, as_built, configuration);
  if (!machine.is_chain()) add_base(machine, as_built.hexapod.base_joint, scene.bodies);
  scene.table = machine.table;
  if (machine.is_chain() && as_built.chain.work_axis >= 0) {
    sim::ChainBodies chain(machine, as_built);
    chain.pose(configuration.axes);
    scene.X_WO = chain.X_WO();
  }
  return scene;
}

std::vector<std::vector<Vec3>> printed_path(const toolpath::Program& program, int after_line,
                                            std::size_t moves_most) {
  std::vector<std::vector<Vec3>> path;
  Vec3 previous = Vec3::Zero();
  bool printing = false;
  std::size_t moves = 0;
  for (const auto& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    const Vec3 tip = step.X_WT.translation();
    if (step.kind == toolpath::StepKind::print && step.line > after_line) {
      if (!printing) path.push_back({previous});
      path.back().push_back(tip);
      if (++moves >= moves_most) break;
    }
    printing = step.kind == toolpath::StepKind::print && step.line > after_line;
    previous = tip;
  }
  return path;
}

}  // namespace understudy::rehearsal

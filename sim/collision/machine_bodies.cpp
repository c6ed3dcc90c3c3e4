#include <string>

#include "sim/collision/collision.h"

namespace understudy::sim {

std::vector<geometry::Shape> machine_bodies(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_WT) {
  std::vector<geometry::Shape> bodies;
  for (geometry::Shape shape : machine.tool.bodies) {
    shape.X_FS = X_WT * shape.X_FS;
    bodies.push_back(std::move(shape));
  }
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    bodies.push_back(geometry::capsule_between("strut " + std::to_string(i + 1),
                                               machine.X_WB * geometry.base_joint[i],
                                               X_WT * geometry.platform_joint[i], machine.strut_radius));
  }
  return bodies;
}

}  // namespace understudy::sim

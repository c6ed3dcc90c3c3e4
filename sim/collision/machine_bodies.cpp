#include "sim/collision/machine_bodies.h"

#include <string>

#include "sim/collision/chain_bodies.h"

namespace understudy::sim {

std::vector<geometry::Shape> hexapod_bodies(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_WT) {
  std::vector<geometry::Shape> bodies;
  for (geometry::Shape shape : machine.tool.bodies) {
    shape.X_FS = X_WT * shape.X_FS;
    bodies.push_back(std::move(shape));
  }
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    bodies.push_back(
        geometry::capsule_between("strut " + std::to_string(i + 1), machine.X_WB * geometry.base_joint[i],
                                  X_WT * geometry.platform_joint[i], machine.hexapod().strut_radius));
  }
  return bodies;
}

std::vector<geometry::Shape> machine_bodies(const machine::MachineDescription& machine,
                                            const AsBuilt& as_built, const Configuration& configuration) {
  if (!machine.is_chain()) return hexapod_bodies(machine, as_built.hexapod, configuration.X_WT);
  std::vector<geometry::Shape> bodies;
  for (geometry::Shape shape : machine.tool.bodies) {
    shape.X_FS = configuration.X_WT * shape.X_FS;
    bodies.push_back(std::move(shape));
  }
  ChainBodies links(machine, as_built);
  links.pose(configuration.axes);
  for (std::size_t i = 0; i < links.items().size(); ++i) {
    bodies.push_back(links.items()[i].shape);
    bodies.back().X_FS = links.place(i);
  }
  return bodies;
}

}  // namespace understudy::sim

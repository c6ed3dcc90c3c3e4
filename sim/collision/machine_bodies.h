// The rigid bodies of a machine, posed in W.
#pragma once

#include <vector>

#include "geometry/shape.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/configuration.h"

namespace understudy::sim {

/// The bodies of a machine: those of the tool, and the struts of a hexapod or the links of a chain. Shared by
/// collision checks and pictures. Each shape's X_FS is its pose in W.
std::vector<geometry::Shape> machine_bodies(const machine::MachineDescription& machine,
                                            const AsBuilt& as_built, const Configuration& configuration);
/// Tool bodies and platform, six strut capsules from base joint to ball joint.
std::vector<geometry::Shape> hexapod_bodies(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_WT);

}  // namespace understudy::sim

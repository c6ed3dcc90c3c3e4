// A hexapod filled by hand (docs/reference.md#machine-g4, G4) and closed meshes of simple solids.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim::test {

/// Tool: nozzle (flat 1 mm, 7 mm wide at 12 mm), heater block, platform. Home tip 50 mm above the table.
machine::MachineDescription hexapod();
AsBuilt as_designed(const machine::MachineDescription& machine);

std::shared_ptr<const geometry::Mesh> box_mesh(const Vec3& centre, const Vec3& size,
                                               const Mat3& R = Mat3::Identity());
/// Round along y, `around` facets, `along` rings; closed.
std::shared_ptr<const geometry::Mesh> bottle_mesh(const Vec3& centre, double radius, double length,
                                                  int around, int along);

}  // namespace understudy::sim::test

// The printed material that the laser's camera may see.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "sim/beads/bead_index.h"

namespace understudy::sim {

/// The beads within `reach` [m] of a point as a mesh in W; null where there is none.
std::shared_ptr<const geometry::Mesh> beads_near(const BeadIndex& beads, const Vec3& p_W, double reach);

}  // namespace understudy::sim

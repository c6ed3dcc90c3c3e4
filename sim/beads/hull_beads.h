// The nearest bead to a body that is a convex mesh.
#pragma once

#include <optional>

#include "sim/beads/bead_index.h"
#include "sim/distance/hull_core.h"

namespace understudy::sim {

/// As BeadIndex::nearest(). Beads are looked at one by one where some are within `cutoff` of the mesh's box,
/// and not at all elsewhere.
std::optional<BeadIndex::Near> nearest_bead(const BeadIndex& beads, const HullCore& hull, const Pose& X_WS,
                                            double cutoff, std::size_t before);

}  // namespace understudy::sim

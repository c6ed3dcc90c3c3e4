#include "sim/beads/hull_beads.h"

#include <algorithm>

#include "sim/beads/bead_shape.h"
#include "sim/distance/convex_solid.h"

namespace understudy::sim {

std::optional<BeadIndex::Near> nearest_bead(const BeadIndex& beads, const HullCore& hull, const Pose& X_WS,
                                            double cutoff, std::size_t before) {
  const Vec3 lower = hull.mesh->lower(), upper = hull.mesh->upper();
  Pose X_WBox = X_WS;
  X_WBox.translation() = X_WS * Vec3(0.5 * (lower + upper));
  const ConvexSolid box{BoxCore{0.5 * (upper - lower)}, 0};
  if (!beads.nearest(box, X_WBox, cutoff, before)) return std::nullopt;
  const Pose X_BoxW = X_WBox.inverse(Eigen::Isometry);
  std::optional<BeadIndex::Near> nearest;
  double limit = cutoff;
  for (std::size_t i = 0; i < std::min(before, beads.size()); ++i) {
    const Bead bead = beads.bead(i);
    const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
        to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
    const double around = 0.5 * ((to - from).norm() + static_cast<double>(bead.width));
    if (signed_distance(box, X_BoxW * Vec3(0.5 * (from + to))) - around > limit) continue;
    const Separation here = separation(hull, 0, X_WS, core_of(bead), limit);
    if (here.distance > limit || (nearest && here.distance >= nearest->separation.distance)) continue;
    nearest = BeadIndex::Near{here, i};
    limit = here.distance;
  }
  return nearest;
}

}  // namespace understudy::sim

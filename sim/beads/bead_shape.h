// From a bead as it was laid to its exact shape, and its distance to convex solids.
#pragma once

#include "core/frames.h"
#include "sim/beads/bead.h"
#include "sim/distance/bead_core.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

/// In W. The bead is one that BeadIndex accepts.
BeadCore core_of(const Bead& bead);

/// Throws InputError: not finite, farther than 100 m from the origin, no section, wider than high turned
/// round, or a normal that is not a unit vector.
void check(const Bead& bead);

/// Of a solid's core, `solid_radius` around it, to the bead, exact to 2 nm while the cores are apart. Where
/// they meet, minus both radii and minus how deep the deepest point of the bead's core is in the solid's (to
/// 0.5 um): not less than the depth of the deepest point of penetration.h, not more than the displacement
/// that would part them. Any distance above `enough` where it is not below.
template <typename Core>
Separation separation(const Core& core, double solid_radius, const Pose& X_WS, const BeadCore& bead_W,
                      double enough);

}  // namespace understudy::sim

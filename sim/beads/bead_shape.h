// The exact shape of a bead: all points within half its height of a flat core.
#pragma once

#include <optional>

#include "core/frames.h"
#include "sim/beads/bead.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

/// A rectangle with the path in its middle; a segment where the section is round; a disc or a point where the
/// bead has no length. The same frame as whoever made it says. [m]
struct BeadCore {
  Vec3 middle{0, 0, 0};
  Vec3 half_along{0, 0, 0}, half_side{0, 0, 0};  ///< perpendicular to each other
  Vec3 up{0, 0, 1};                              ///< unit, perpendicular to both
  double disc_radius = 0;                        ///< of a blob
  double radius = 0;                             ///< half the bead's height, all around the core

  Vec3 farthest(const Vec3& direction) const;
  Vec3 nearest(const Vec3& p) const;
  double reach() const;  ///< of the bead's surface from the middle, at most
};

/// In W. The bead is one that BeadIndex accepts.
BeadCore core_of(const Bead& bead);
BeadCore in_frame(const BeadCore& bead_W, const Pose& X_FW);

/// Throws InputError: not finite, farther than 100 m from the origin, no section, wider than high turned
/// round, or a normal that is not a unit vector.
void check(const Bead& bead);

/// Of a solid's core, `solid_radius` around it, to the bead, exact to 2 nm while the cores are apart. Where
/// they meet, minus both radii and minus how deep the deepest point of the bead's core is in the solid's (to
/// 0.5 um): not less than the depth of the deepest point of penetration.h, not more than the way that would
/// part them. Any distance above `enough` where it is not below.
template <typename Core>
Separation separation(const Core& core, double solid_radius, const Pose& X_WS, const BeadCore& bead_W,
                      double enough);

/// From `p` to the bead's surface, negative inside.
double signed_distance(const BeadCore& bead, const Vec3& p);
/// Outward at a point on or near the surface; `fallback` in the core itself.
Vec3 normal_at(const BeadCore& bead, const Vec3& p, const Vec3& fallback);

/// Where the ray along the unit vector `direction` goes in, at most `reach` away; 0 from inside.
std::optional<double> entry(const BeadCore& bead, const Vec3& origin, const Vec3& direction, double reach);
/// Where it comes out for good; nothing for a ray that misses or has passed.
std::optional<double> leaving(const BeadCore& bead, const Vec3& origin, const Vec3& direction);

}  // namespace understudy::sim

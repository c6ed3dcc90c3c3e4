// The exact shape of a bead: all points within half its height of a flat core.
#pragma once

#include <optional>

#include "core/frames.h"

namespace understudy::sim {

/// A rectangle with the path in its middle; a segment where the section is round; a disc or a point where the
/// bead has no length. In the frame that its maker states. [m]
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

BeadCore in_frame(const BeadCore& bead_W, const Pose& X_FW);

/// From `p` to the bead's surface, negative inside.
double signed_distance(const BeadCore& bead, const Vec3& p);
/// Outward at a point on or near the surface; `fallback` in the core itself.
Vec3 normal_at(const BeadCore& bead, const Vec3& p, const Vec3& fallback);

/// Where the ray along the unit vector `direction` goes in, at most `reach` away; 0 from inside.
std::optional<double> entry(const BeadCore& bead, const Vec3& origin, const Vec3& direction, double reach);
/// Where it comes out for good; nothing for a ray that misses or has passed.
std::optional<double> leaving(const BeadCore& bead, const Vec3& origin, const Vec3& direction);

}  // namespace understudy::sim

// The top of a table: about the plane z = 0 of W, but higher or lower, leaning, and bowed.
#pragma once

#include <limits>
#include <optional>

#include "core/frames.h"

namespace understudy::geometry {

struct TableSurface {
  double height = 0;    ///< [m], of the origin of W's x and y
  Vec2 slope{0, 0};     ///< [m/m], of z over x and y there; small
  double bow = 0;       ///< [m], by which a rim of `radius` about the origin lies lower; negative: a dish
  double radius = 0.1;  ///< [m]
  /// [m], half its sides along x and y of W: nothing lies beside it.
  Vec2 half_sides{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

  double z(const Vec2& p) const { return height + slope.dot(p) - bow * p.squaredNorm() / (radius * radius); }
  bool reaches(const Vec2& p) const { return (p.cwiseAbs().array() <= half_sides.array()).all(); }
  Vec3 normal(const Vec2& p) const;  ///< unit, upward
  /// Distance [m] along a ray to the table from above, `direction` a unit vector: negative from a place below
  /// it. Nothing: the ray does not go down to it, or passes beside it.
  std::optional<double> ray_hit(const Vec3& origin, const Vec3& direction) const;
};

}  // namespace understudy::geometry

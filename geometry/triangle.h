// Exact queries on one triangle.
#pragma once

#include <array>
#include <optional>

#include "core/frames.h"

namespace understudy::geometry {

/// Part of a triangle that a nearest point lies on: corner 0..2, edge k -> k + 1, or the inside.
enum class Feature { corner0, corner1, corner2, edge0, edge1, edge2, inside };

struct TrianglePoint {
  Vec3 barycentric;
  Feature feature = Feature::inside;
};

/// Nearest point of the triangle with an area (Ericson 2005, 5.1.5).
TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A ray made ready for watertight tests (Woop, Benthin, Wald 2013): of two triangles that share an edge, at
/// least one is hit by a ray through that edge.
class WatertightRay {
 public:
  WatertightRay(const Vec3& origin, const Vec3& direction);

  struct Hit {
    double distance;  ///< [m], >= 0
    Vec3 barycentric;
  };
  std::optional<Hit> hit(const Vec3& a, const Vec3& b, const Vec3& c) const;
  /// Where the ray enters the box, or more than `reach` when it misses it or enters later.
  double entry(const Vec3& lower, const Vec3& upper, double reach) const;

 private:
  Vec3 origin_;
  Vec3 inverse_;
  int x_, y_, z_;  // axes, z the direction's largest
  Vec3 shear_;
};

}  // namespace understudy::geometry

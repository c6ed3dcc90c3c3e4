// The one section of a part that belongs to a place of its structural line.
#pragma once

#include <optional>
#include <vector>

#include "geometry/mesh.h"
#include "toolpath/planners/contour_offset.h"

namespace understudy::toolpath {

/// A plane with axes of its own: p = origin + u x + v y, the normal is u x v.
struct SectionFrame {
  Vec3 origin{0, 0, 0}, u = Vec3::UnitX(), v = Vec3::UnitY();

  Vec3 normal() const { return u.cross(v); }
  Vec3 out(const Vec2& q) const { return origin + q.x() * u + q.y() * v; }
  Vec2 in(const Vec3& p) const { return {(p - origin).dot(u), (p - origin).dot(v)}; }
  /// Across `normal` at `point`, turned as little from this one as can be.
  SectionFrame carried_to(const Vec3& point, const Vec3& normal) const;
};

struct FlatSection {
  std::vector<Contour> contours;  ///< the outline first, counter-clockwise, then its holes
  double area = 0;                ///< [m^2]
  Vec2 centroid{0, 0};
  double radius = 0;  ///< [m], of the outline's farthest point from the frame's origin

  bool holds(const Vec2& q) const;  ///< within the outline, in no hole
};

/// The piece of the section of `part` that the frame's origin lies in, or else whose outline is nearest, no
/// farther than its own width. Nothing where the plane misses the part there.
std::optional<FlatSection> section_at(const geometry::Mesh& part, const SectionFrame& frame);

}  // namespace understudy::toolpath

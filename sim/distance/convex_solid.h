// Rigid convex solids as support functions and nearest points: what an exact distance to triangles needs.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/frames.h"
#include "geometry/shape.h"

namespace understudy::sim {

/// Each core is a closed convex set about the shape's own frame. [m]
struct PointCore {
  Vec3 farthest(const Vec3& direction) const;  ///< any point of the set that is farthest along it
  Vec3 nearest(const Vec3& p) const;           ///< p itself when inside
  double depth(const Vec3& p) const;           ///< from p inside to the boundary; 0 outside
};
struct SegmentCore {
  double half = 0;
  Vec3 farthest(const Vec3& direction) const;
  Vec3 nearest(const Vec3& p) const;
  double depth(const Vec3& p) const;
};
struct FrustumCore {
  double radius_low = 0, radius_high = 0;
  double low = 0, high = 0;  ///< z of its two discs
  Vec3 farthest(const Vec3& direction) const;
  Vec3 nearest(const Vec3& p) const;
  double depth(const Vec3& p) const;
};
struct BoxCore {
  Vec3 half{0, 0, 0};
  Vec3 farthest(const Vec3& direction) const;
  Vec3 nearest(const Vec3& p) const;
  double depth(const Vec3& p) const;
};

/// All points within `radius` of the core.
struct ConvexSolid {
  std::variant<PointCore, SegmentCore, FrustumCore, BoxCore> core;
  double radius = 0;
};

/// Nothing for a mesh.
std::optional<ConvexSolid> convex_solid(const geometry::Shape& shape);

/// Signed, negative inside; exact. `p` in the solid's frame.
double signed_distance(const ConvexSolid& solid, const Vec3& p);

/// Balls that lie inside the solid and reach its surface all over, so that the deepest of them gives the
/// depth of the solid in another body: rims and discs of round bodies, faces of boxes, points along
/// capsules at most 1 mm apart.
struct Ball {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};
std::vector<Ball> surface_balls(const ConvexSolid& solid);

/// Largest distance of a point of the solid from the origin of its owner's frame.
double reach(const ConvexSolid& solid, const Pose& X_FS);

}  // namespace understudy::sim

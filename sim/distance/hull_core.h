// A convex mesh as the core of distances: what convex_solid.h has for round bodies and boxes.
#pragma once

#include <memory>

#include "core/frames.h"
#include "geometry/mesh.h"

namespace understudy::sim {

/// Of a closed mesh that is its own convex hull (geometry/convex_hull.h), in the mesh's own frame. [m]
struct HullCore {
  std::shared_ptr<const geometry::Mesh> mesh;
  Vec3 farthest(const Vec3& direction) const;  ///< any vertex that is farthest along it
  Vec3 nearest(const Vec3& p) const;           ///< p itself when inside
  double depth(const Vec3& p) const;           ///< from p inside to the boundary; 0 outside
};

/// Largest distance of a vertex from the origin of the owner's frame.
double reach(const HullCore& hull, const Pose& X_FS);

}  // namespace understudy::sim

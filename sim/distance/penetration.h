// How deep two overlapping bodies are in each other.
#pragma once

#include "core/frames.h"
#include "geometry/shape.h"

namespace understudy::sim {

struct Penetration {
  double depth = 0;       ///< [m]; 0 where only edges cross, or with an open mesh
  Vec3 place_W{0, 0, 0};  ///< of the deepest point
};

/// Depth of the deepest point of either body's surface inside the other, over the points that
/// surface_balls() or the mesh's vertices give: never more than the true value.
Penetration penetration(const geometry::Shape& a, const Pose& X_Wa, const geometry::Shape& b,
                        const Pose& X_Wb);

/// Whether the point is inside the shape; false for open meshes.
bool contains(const geometry::Shape& shape, const Vec3& p_S);

/// A point that belongs to the shape, in its frame.
Vec3 point_of(const geometry::Shape& shape);

}  // namespace understudy::sim

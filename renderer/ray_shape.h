// Exact rays against rigid shapes, for the truth that pictures are compared with.
#pragma once

#include <optional>

#include "geometry/shape.h"

namespace understudy::renderer {

/// Distance [m] along the ray (unit `direction`, coordinates of the shape's owner) to the first crossing of
/// the surface, entering or leaving, in (0, reach).
std::optional<double> ray_hit(const geometry::Shape& shape, const Vec3& origin, const Vec3& direction,
                              double reach);

}  // namespace understudy::renderer

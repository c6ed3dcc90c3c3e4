// The curve in which a plane cuts the side of a part that faces up.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// The intersection of the mesh with a plane through `point` with unit `normal`: the longest connected
/// polyline on the side that faces `up` (unit). It runs with its inside (the material) on the left, seen from
/// the tip of `normal`. Throws InputError when the plane misses the mesh or nothing faces `up`.
std::vector<Vec3> section_curve(const geometry::Mesh& mesh, const Vec3& point, const Vec3& normal,
                                const Vec3& up);

}  // namespace understudy::toolpath

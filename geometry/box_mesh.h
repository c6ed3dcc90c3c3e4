// Boxes as triangle meshes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/frames.h"
#include "geometry/mesh.h"

namespace understudy::geometry {

/// The corners between two opposite ones: corner i is at the upper x, y or z where bit 0, 1 or 2 of i is set.
/// [m]
std::vector<Vec3> box_corners(const Vec3& lower, const Vec3& upper);

/// Two triangles a face over corners in the order of box_corners, counter-clockwise outside; for any
/// hexahedron with plane faces. The bottom's two come first, then the top's.
const std::vector<std::array<int, 3>>& box_triangles();

/// The closed box from `lower` to `upper`, then moved by X. [m]
std::shared_ptr<const Mesh> box_mesh(const Vec3& lower, const Vec3& upper, const Pose& X = Pose::Identity());

}  // namespace understudy::geometry

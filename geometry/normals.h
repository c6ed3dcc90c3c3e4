// Vertex normals: smooth over curved faces, separate on the two sides of a crease.
#pragma once

#include <array>
#include <vector>

#include "core/frames.h"

namespace understudy::geometry {

/// Unit, or zero when the triangle has no area to speak of.
Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// Duplicates the vertices on creases (the copies go behind the others and `triangles` is rewritten) and
/// returns the smooth normal of every vertex. Faces are weighted by corner angle, so that the way in which a
/// flat face is cut into triangles does not matter, times area, so that the large flat facets of a CAD part
/// keep their normal beside the small facets of its fillets.
std::vector<Vec3> split_creases(std::vector<Vec3>& vertices, std::vector<std::array<int, 3>>& triangles,
                                const std::vector<std::array<int, 3>>& neighbours, double crease_angle);

/// Angle-weighted pseudo-normals of all vertices over all faces around them, not normalised
/// (Baerentzen and Aanaes 2005).
std::vector<Vec3> vertex_pseudo_normals(const std::vector<Vec3>& vertices,
                                        const std::vector<std::array<int, 3>>& triangles);

}  // namespace understudy::geometry

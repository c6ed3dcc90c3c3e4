// Convex hulls, and the points of mesh files that they are made of.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/frames.h"

namespace understudy::geometry {

class Mesh;

/// Vertices of an STL, COLLADA (.dae), OBJ or PLY file, in the unit of the file; of COLLADA, in metres, its
/// parts placed as its scene has them. Throws InputError naming the file for one that is missing, too large,
/// no such file, without a triangle, or that holds a number that is not finite, and for one on which its
/// importer crashes or goes beyond the limits of docs/limits.md: it runs contained.
std::vector<Vec3> read_mesh_points(const std::filesystem::path& path);

/// The hull of the points as a closed mesh. Throws InputError where they lie in a plane or on a line, and for
/// one that is not finite. `what` names them in it.
std::shared_ptr<const Mesh> convex_hull(const std::vector<Vec3>& points, const std::string& what);

}  // namespace understudy::geometry

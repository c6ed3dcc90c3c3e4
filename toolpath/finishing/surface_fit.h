// The normal of a part's surface by a fit to the points around (Yu 2023, algorithm 1).
#pragma once

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// Outward unit normal at `at`, a point of the mesh's surface: of the quadric z = a + b x + c y + d x^2 + e x
/// y + f y^2 nearest in least squares to 25 points of the surface within `reach` [m] of it, in a plane that
/// touches. Points beyond an edge (geometry::kCreaseAngle) are left out; with too few points it is the mesh's
/// own normal.
Vec3 fitted_normal(const geometry::Mesh& mesh, const geometry::SurfacePoint& at, double reach);

}  // namespace understudy::toolpath

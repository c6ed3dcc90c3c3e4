// A polyline near a surface to points on it, dense enough for the tip to follow.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

struct SamplingLimits {
  double gap;              ///< [m], of the tip's path above the surface
  double step;             ///< [m]
  double chord_tolerance;  ///< [m], of the tip's straight moves from the true offset path
};

/// Points in order along the curve, at least two. Throws InputError as plan_surface does.
std::vector<geometry::SurfacePoint> sample_curve(const geometry::Mesh& mesh, const std::vector<Vec3>& curve,
                                                 const SamplingLimits& limits);

}  // namespace understudy::toolpath

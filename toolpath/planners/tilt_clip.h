// The stretch of a curve over which the surface tilts within limits.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// Tilt of a surface normal [rad]: the angle about `swing_axis` (unit, level) from vertical to the normal.
/// Positive about y leans to +x.
double tilt_about(const Vec3& surface_normal, const Vec3& swing_axis);

/// The longest part of the curve over which the mesh's normal tilts from tilt_min to tilt_max [rad]. Starts
/// at tilt_min if it reaches it, with ends on the limits to 1e-9 rad where the normal passes them smoothly.
/// The tilt is taken to be monotonic between two points of the curve.
/// Throws InputError when tilt_min is not below tilt_max or no part of the curve lies between them.
std::vector<Vec3> clip_by_tilt(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, double tilt_min,
                               double tilt_max, const Vec3& swing_axis);

}  // namespace understudy::toolpath

// G5: cubic splines as rows of chords.
#pragma once

#include <array>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// The ends of chords no farther than `tolerance` [m] from the cubic Bezier curve of these control points;
/// the last is control[3].
std::vector<Vec3> spline_points(const std::array<Vec3, 4>& control, double tolerance);

}  // namespace understudy::toolpath

// Measures of a polyline. All [m].
#pragma once

#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

double polyline_length(const std::vector<Vec3>& points);

/// Distance of `p` to the segment from `a` to `b`.
double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);

}  // namespace understudy::toolpath

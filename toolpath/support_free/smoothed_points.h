// The smoothest row of points near a given one.
#pragma once

#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// Points that stand evenly along a line, moved by at most `tolerance` [m] each so that their curvature
/// changes as little as can be (least sum of squared third differences); the first and the last stay. What
/// bends evenly stays as it is. Source: Whittaker 1923, On a new method of graduation; the weight is the
/// largest within the tolerance.
std::vector<Vec3> smoothed_points(const std::vector<Vec3>& points, double tolerance);

}  // namespace understudy::toolpath

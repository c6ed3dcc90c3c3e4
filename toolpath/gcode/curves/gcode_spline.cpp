#include "toolpath/gcode/curves/gcode_spline.h"

#include <algorithm>
#include <cmath>

namespace understudy::toolpath {

std::vector<Vec3> spline_points(const std::array<Vec3, 4>& control, double tolerance) {
  const auto& [p0, p1, p2, p3] = control;
  // A chord over a share h of the parameter is at most h^2 / 8 of the largest second derivative away, which a
  // cubic has at one of its ends.
  const double bend = 6 * std::max((p2 - 2 * p1 + p0).norm(), (p3 - 2 * p2 + p1).norm());
  const int count = std::max(1, static_cast<int>(std::ceil(std::sqrt(bend / (8 * tolerance)))));
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 1; i < count; ++i) {
    const double t = static_cast<double>(i) / count, s = 1 - t;
    points.emplace_back(s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3);
  }
  points.push_back(p3);
  return points;
}

}  // namespace understudy::toolpath

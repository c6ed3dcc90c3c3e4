#include "toolpath/arc_chords.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::toolpath {

double chord_angle(double radius, double tolerance) {
  constexpr double kLongest = std::numbers::pi / 8;
  if (!(radius > tolerance)) return kLongest;
  // 2 acos(1 - t / r) without its cancellation on large circles.
  return std::min(kLongest, 4 * std::asin(std::sqrt(tolerance / (2 * radius))));
}

double chord_count(double sweep, double chord) {
  return std::max(1.0, std::ceil(std::abs(sweep) / chord - 1e-9));
}

}  // namespace understudy::toolpath

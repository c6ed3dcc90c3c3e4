#include "sim/deposition/bead_section.h"

#include <cmath>
#include <numbers>

namespace understudy::sim {

double bead_width(double area, double gap) {
  constexpr double kQuarterPi = std::numbers::pi / 4;
  if (gap <= 0 || area <= kQuarterPi * gap * gap) return std::sqrt(area / kQuarterPi);
  return area / gap + gap * (1 - kQuarterPi);
}

double bead_height(double area, double width) {
  constexpr double kQuarterPi = std::numbers::pi / 4, kEdges = 1 - kQuarterPi;
  const double round = std::sqrt(area / kQuarterPi);
  if (width <= round) return round;
  return (width - std::sqrt(width * width - 4 * kEdges * area)) / (2 * kEdges);
}

}  // namespace understudy::sim

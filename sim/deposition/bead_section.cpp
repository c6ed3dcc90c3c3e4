#include "sim/deposition/bead_section.h"

#include <cmath>
#include <numbers>

namespace understudy::sim {

double bead_width(double area, double gap) {
  constexpr double kQuarterPi = std::numbers::pi / 4;
  if (gap <= 0 || area <= kQuarterPi * gap * gap) return std::sqrt(area / kQuarterPi);
  return area / gap + gap * (1 - kQuarterPi);
}

}  // namespace understudy::sim

#include "toolpath/bead.h"

#include <numbers>

namespace understudy::toolpath {

double bead_area(double width, double height) {
  return (width - height) * height + std::numbers::pi / 4 * height * height;
}

double strand_area(double diameter) { return std::numbers::pi / 4 * diameter * diameter; }

}  // namespace understudy::toolpath

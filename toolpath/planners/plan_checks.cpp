#include "toolpath/planners/plan_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kStepsMax = 1e7;  // of one path; docs/limits.md

}  // namespace

void check_positive(const char* name, double value, const char* unit) {
  if (!(value > 0 && std::isfinite(value)))
    throw InputError(fmt::format("{} is {:g} {}, it must be above 0 {}", name, value, unit, unit));
}

void check_within(const char* name, double value, double lowest, double highest, const char* unit) {
  if (!(value >= lowest && value <= highest))
    throw InputError(
        fmt::format("{} is {:g} {}, outside {:g} to {:g} {}", name, value, unit, lowest, highest, unit));
}

void check_bead(double width, double height) {
  check_positive("bead width", to_mm(width), "mm");
  check_positive("bead height", to_mm(height), "mm");
  if (width < height)
    throw InputError(
        fmt::format("bead width is {:g} mm, less than its height of {:g} mm", to_mm(width), to_mm(height)));
}

void check_nozzle(double temperature, double fan) {
  if (!(fan >= 0 && fan <= 1)) throw InputError(fmt::format("fan is {:g}, outside 0 to 1", fan));
  if (!(temperature >= 0 && std::isfinite(temperature)))
    throw InputError(fmt::format("temperature is {:g} K, it must not be below 0 K", temperature));
}

int step_count(double length, double step) {
  const double steps = std::ceil(length / step);
  if (!(steps <= kStepsMax))
    throw InputError(fmt::format(
        "a path of {:.3g} steps, more than {:g}: choose longer steps, or is the part in another unit?", steps,
        kStepsMax));
  return std::max(1, static_cast<int>(steps));
}

std::string in_mm(const Vec3& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", to_mm(p.x()), to_mm(p.y()), to_mm(p.z()));
}

}  // namespace understudy::toolpath

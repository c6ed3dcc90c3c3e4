#include "rehearsal/findings/place_text.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal {

std::string place_text(const Vec3& p_W) {
  // No -0, which would hang on the last bit.
  const auto mm = [](double v) { return std::round(100 * to_mm(v)) / 100 + 0.0; };
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) mm", mm(p_W.x()), mm(p_W.y()), mm(p_W.z()));
}

}  // namespace understudy::rehearsal

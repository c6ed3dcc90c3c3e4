#include "toolpath/lattice/strut_range.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kStep = 0.1 * kMillimetre;  // between lengths that are looked at

// As the strut begins; on its way up the tool only gets farther away. The tool is solid about its axis here,
// so struts farther away than the next one have more room.
bool has_room(const ToolEnvelope& tool, double diameter, double margin, double length) {
  const Vec3 tip(0, 0, 0.5 * diameter), foot(length, 0, 0);
  const StrutBody next{foot, foot + length * Vec3::UnitZ(), 0.5 * diameter};
  return tool.clears(next, {tip, tip, Vec3::UnitZ()}, margin);
}

}  // namespace

std::vector<StrutRange> strut_ranges(const ToolEnvelope& tool, double diameter, double margin) {
  const auto good = [&](double length) { return has_room(tool, diameter, margin, length); };
  const auto edge = [&](double with, double without) {
    while (std::abs(with - without) > kMicrometre) {
      const double half = 0.5 * (with + without);
      (good(half) ? with : without) = half;
    }
    return with;
  };
  std::vector<StrutRange> ranges;
  bool before = false;
  const int steps = static_cast<int>(std::round((kLongestLooked - kShortestLooked) / kStep));
  for (int n = 0; n <= steps; ++n) {
    const double length = kShortestLooked + n * kStep;
    const bool now = good(length);
    if (now && !before) ranges.push_back({n == 0 ? length : edge(length, length - kStep), kLongestLooked});
    if (!now && before) ranges.back().to = edge(length - kStep, length);
    before = now;
  }
  return ranges;
}

bool in_ranges(double length, const std::vector<StrutRange>& ranges) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const StrutRange& r) {
    return length >= r.from - kMicrometre && length <= r.to + kMicrometre;
  });
}

std::string to_string(const std::vector<StrutRange>& ranges) {
  if (ranges.empty()) return "no length";
  std::string text;
  for (const StrutRange& r : ranges)
    text += fmt::format("{}{:.2f}..{:.2f}", text.empty() ? "" : " or ", std::ceil(to_mm(r.from) * 100) / 100,
                        std::floor(to_mm(r.to) * 100) / 100);
  return text + " mm";
}

}  // namespace understudy::toolpath

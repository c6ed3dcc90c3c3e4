#include "report/gltf/bead_colours.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/quantile.h"
#include "core/units.h"
#include "report/picture/body_colours.h"

namespace understudy::report {
namespace {

using Srgb = std::array<double, 3>;  // 0 to 255

constexpr std::array<Srgb, 10> kCividis{{{0, 34, 78},
                                         {18, 53, 112},
                                         {59, 73, 108},
                                         {87, 93, 109},
                                         {112, 113, 115},
                                         {138, 134, 120},
                                         {165, 156, 116},
                                         {195, 179, 105},
                                         {225, 204, 85},
                                         {254, 232, 56}}};
constexpr Srgb kTooNear{0, 84, 148}, kInBand{214, 214, 206}, kTooFar{163, 82, 0}, kUnknown{128, 128, 128};

Srgb mix(const Srgb& a, const Srgb& b, double share) {
  Srgb colour{};
  for (std::size_t i = 0; i < 3; ++i) colour[i] = a[i] + share * (b[i] - a[i]);
  return colour;
}

Srgb cividis(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kCividis.size() - 1);
  const std::size_t i = std::min(kCividis.size() - 2, static_cast<std::size_t>(at));
  return mix(kCividis[i], kCividis[i + 1], at - static_cast<double>(i));
}

Srgb about_band(double value, const GapBand& band) {
  const double width = band.max - band.min;
  const auto beyond = [&](const Srgb& end, double by) {
    return mix(mix(kInBand, end, 0.45), end, std::min(1.0, by / width));
  };
  if (value < band.min) return beyond(kTooNear, band.min - value);
  if (value > band.max) return beyond(kTooFar, value - band.max);
  return kInBand;
}

/// IEC 61966-2-1: vertex colours of glTF are of linear light.
std::array<std::uint8_t, 4> linear(const Srgb& colour) {
  std::array<std::uint8_t, 4> result{0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = colour[i] / 255;
    const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    result[i] = static_cast<std::uint8_t>(std::lround(255 * light));
  }
  return result;
}

}  // namespace

BeadColour bead_colour_of(const std::string& word) {
  if (word == "gap") return BeadColour::gap;
  if (word == "width") return BeadColour::width;
  if (word == "plain") return BeadColour::plain;
  throw InputError("--colour " + word + ": gap, width or plain is needed");
}

BeadColours::BeadColours(const RecordedReplay& replay, BeadColour what) : replay_(replay), what_(what) {
  if (what == BeadColour::plain) legend_ = "plain";
  if (what == BeadColour::width) {
    std::vector<double> widths;
    for (const auto& stretch : replay.beads)
      for (const auto& section : stretch) widths.push_back(section.width);
    widest_ = widths.empty() ? 1 : quantile(widths, 0.999);
    legend_ = fmt::format("width, dark blue 0 mm to yellow {:.3f} mm", to_mm(widest_));
  }
  if (what != BeadColour::gap) return;
  if (!replay.gap_band)
    throw InputError("--colour gap: the machine states no gap that it accepts; --colour width needs none");
  legend_ = fmt::format("gap, grey {:.2f} to {:.2f} mm, blue below, brown above", to_mm(replay.gap_band->min),
                        to_mm(replay.gap_band->max));
}

double BeadColours::gap_at(double time) const {
  const auto after = std::lower_bound(replay_.path.begin(), replay_.path.end(), time,
                                      [](const auto& point, double t) { return point.time < t; });
  if (after == replay_.path.end()) return replay_.path.back().gap;
  if (after == replay_.path.begin() || after->time == time) return after->gap;
  const auto before = std::prev(after);
  return before->gap + (time - before->time) / (after->time - before->time) * (after->gap - before->gap);
}

std::array<std::uint8_t, 4> BeadColours::at(const sim::BeadSection& section) const {
  if (what_ == BeadColour::width) return linear(cividis(section.width / widest_));
  if (what_ == BeadColour::gap) {
    constexpr double kLag = 1e-3;  // [s]: a bead's last instant may be that of the lift behind it
    const double gap = gap_at(section.laid_at - kLag);
    return linear(std::isfinite(gap) ? about_band(gap, *replay_.gap_band) : kUnknown);
  }
  std::array<std::uint8_t, 4> plain{0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) plain[i] = static_cast<std::uint8_t>(std::lround(255 * kFilament[i]));
  return plain;
}

}  // namespace understudy::report

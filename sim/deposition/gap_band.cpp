#include "sim/deposition/gap_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/printed_clearance.h"

namespace understudy::sim {
namespace {

static_assert(kSoftDepth == geometry::kNozzlePress);  // planners keep to the same rule

constexpr double kSameLayer = 0.15;   // of the aim
constexpr double kLeastAspect = 1.4;  // width over height: the flattest of slicers' default profiles is above
constexpr double kStillPressed = 0.95;  // of the free strand's diameter
constexpr double kLowestOfHigh = 0.75;
constexpr double kQuarterPi = std::numbers::pi / 4;

}  // namespace

GapBand gap_band(const machine::GapLimits& limits) { return {limits.accepted_min, limits.accepted_max}; }

GapBand gap_band(const machine::GapLimits& limits, double layer, double area) {
  const GapBand stated = gap_band(limits);
  if (std::abs(layer - limits.aim) <= kSameLayer * limits.aim) return stated;
  GapBand band;
  band.low = layer > limits.aim ? std::max(stated.low, layer / 2) : layer * limits.accepted_min / limits.aim;
  band.soft_depth = std::max(kSoftDepth, layer / 2);
  // (w - g) g + pi g^2 / 4 = area with w = aspect g.
  const double widest_gap = std::sqrt(area / (kLeastAspect - 1 + kQuarterPi));
  const double pressed = kStillPressed * std::sqrt(area / kQuarterPi);
  band.high = std::min(layer + limits.accepted_max - limits.aim, layer <= widest_gap ? pressed : widest_gap);
  // A thin line has the machine's band, not less.
  if (layer > limits.aim) band.high = std::max(band.high, stated.high);
  band.low = std::min(band.low, kLowestOfHigh * band.high);  // where the line is too thin for its layer
  return band;
}

}  // namespace understudy::sim

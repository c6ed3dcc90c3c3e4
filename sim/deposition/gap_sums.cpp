#include "sim/deposition/gap_sums.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

constexpr double kRounding = 1e-9;  // [m], of a gap: coordinates of 0.1 m through files and rotations

// Share of a linear ramp of the gap that is at or below `level`.
double share_below(double from, double to, double level) {
  const double low = std::min(from, to), high = std::max(from, to);
  if (high <= level) return 1;
  if (low > level || std::isinf(high)) return low > level ? 0 : 0.5;
  return (level - low) / (high - low);
}

}  // namespace

void GapSums::add(double from, double to, const GapBand& band, double length, double time, int line) {
  if (length <= 0) return;
  length_ += length;
  const double below = share_below(from, to, band.low - kRounding);
  below_ += length * below;
  in_band_ += length * (share_below(from, to, band.high + kRounding) - below);
  if (!std::isfinite(from) || !std::isfinite(to)) return;
  surface_length_ += length;
  moment_ += 0.5 * (from + to) * length;
  max_ = std::max({max_, from, to});
  if (const double low = std::min(from, to); low < min_) {
    min_ = low;
    min_time_ = time;
    min_line_ = line;
  }
  // The first of equals: lines at one height differ by rounding.
  if (const double low = std::min(from, to); low - band.low < margin_ - kRounding) {
    margin_ = low - band.low;
    lowest_ = {low, band.low, time, line};
  }
}

void GapSums::fill(DepositionSummary& summary) const {
  summary.length = length_;
  if (length_ > 0) {
    summary.in_band_fraction = in_band_ / length_;
    summary.below_band_fraction = below_ / length_;
    summary.above_band_fraction = std::max(0.0, 1 - summary.in_band_fraction - summary.below_band_fraction);
  }
  if (surface_length_ <= 0) return;
  summary.gap_min = min_;
  summary.gap_min_line = min_line_;
  summary.gap_min_time = min_time_;
  summary.gap_mean = moment_ / surface_length_;
  summary.gap_max = max_;
  summary.lowest = lowest_;
}

}  // namespace understudy::sim

#include "sim/deposition/extruder.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {

Extruder::Flow Extruder::advance(double fed, double duration) {
  const double step = fed - fed_;
  fed_ = fed;
  if (column_ + std::max(0.0, step) <= 0) {  // drawn back, and not forward enough
    column_ += step;
    return {};
  }
  double refill = 0;  // share of the interval
  if (column_ < 0) {
    refill = -column_ / step;
    column_ = 0;
  }
  Flow flow;
  if (lag_ > 0 && duration > 0) {
    flow = advance_full(step / duration, (1 - refill) * duration);
  } else {
    const double total = column_ + (1 - refill) * step;
    flow.filament = std::max(0.0, total);
    column_ = std::min(0.0, total);
  }
  flow.from = refill;
  return flow;
}

// d(column)/dt = rate - column / lag while there is a column; below 0 nothing flows.
Extruder::Flow Extruder::advance_full(double rate, double duration) {
  const double level = rate * lag_, begin = column_;
  double flowing = duration;
  if (level < 0) flowing = std::min(duration, lag_ * std::log((begin - level) / -level));
  const double end = level - (level - begin) * std::exp(-flowing / lag_);
  Flow flow;
  flow.filament = std::max(0.0, begin + rate * flowing - end);
  column_ = begin + rate * duration - flow.filament;
  return flow;
}

}  // namespace understudy::sim

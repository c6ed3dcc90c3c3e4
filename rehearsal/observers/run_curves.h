// What a run's drives carried, how warm it printed and how near it came, over its whole time.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "kinematics/axis_vector.h"
#include "sim/plant/load_flips.h"

namespace understudy::rehearsal {

/// The least and the most of a quantity. Empty until something finite is added.
struct Span {
  float low = std::numeric_limits<float>::infinity(), high = -low;

  bool empty() const { return low > high; }
  void add(double value) {
    low = std::min(low, static_cast<float>(value));
    high = std::max(high, static_cast<float>(value));
  }
  void add(const Span& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

/// A stretch of the run's time.
struct CurveStretch {
  double begin = 0, end = 0;          ///< [s], first and last snapshot
  kinematics::PerAxis<Span> force{};  ///< [N] or [N m], what each drive carried
  Span nozzle_temperature;            ///< [K]; empty while the heater is off
  Span interface_temperature;         ///< [K], of a bead with the one that it is laid on
  /// [m], of the nozzle to the part, or to the table where there is no part; empty where nothing could come
  /// nearer than at the looks before and after (sim::CollisionObserver).
  Span nozzle_clearance;

  void add(const CurveStretch& next);
};

struct RunCurves {
  std::vector<CurveStretch> stretches;  ///< in order, none between them
  std::vector<sim::LoadFlip> flips;     ///< of struts in closed loops: the first ones
  std::size_t flip_count = 0;
  double glass_transition = 0;  ///< [K]; an interface below it does not weld. 0: nothing of the kind
};

}  // namespace understudy::rehearsal

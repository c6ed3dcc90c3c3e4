// One cycle of a planned motion: what leaves the planner and goes to the port.
#pragma once

#include "core/frames.h"
#include "machine/port.h"

namespace understudy::control {

/// One planned cycle. `X_WT` is the commanded pose that the axes were computed from.
struct PlannedPoint {
  machine::Setpoint setpoint;
  Pose X_WT = Pose::Identity();
  std::size_t step = 0;  ///< that this serves, counting the pushes from 0
  double fraction = 0;   ///< of that step's path (of its time, where it does not move), in [0, 1]
};

}  // namespace understudy::control

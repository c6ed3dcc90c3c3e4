// Where a machine is.
#pragma once

#include "core/frames.h"
#include "machine/port.h"

namespace understudy::sim {

struct Configuration {
  Pose X_WT = Pose::Identity();
  kinematics::AxisVector axes{};  ///< [m] or [rad], by the drives; they pose the links of an open chain
};

}  // namespace understudy::sim

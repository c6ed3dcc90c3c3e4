// Where the tool stands before anything moves.
#pragma once

#include "machine/description.h"
#include "machine/port.h"

namespace understudy::control {

/// X_WT: home, unless the drives read otherwise. Throws MachineError where they read what belongs to no pose.
Pose standing_pose(const machine::MachineDescription& machine, const machine::MachinePort& port);

}  // namespace understudy::control

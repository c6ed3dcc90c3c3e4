// Kinematics of many poses that have nothing to do with each other, as a table on standard input holds them.
// A hexapod's are solved several at a time and on all cores; every answer is that of a Mechanism's single
// call. Not for control cycles.
#pragma once

#include <span>
#include <vector>

#include "machine/description.h"

namespace understudy::machine {

struct SolvedAxes {
  kinematics::SolveStatus status = kinematics::SolveStatus::not_converged;
  kinematics::AxisVector axes{};
};
/// Mechanism::inverse of each pose, near home.
std::vector<SolvedAxes> solve_axes(const MachineDescription& machine, std::span<const Pose> X_BT);

struct SolvedPose {
  kinematics::SolveStatus status = kinematics::SolveStatus::not_converged;
  Pose X_BT = Pose::Identity();
};
/// Mechanism::forward of each row, seeded with home. Where a hexapod has no answer near home, the assembly
/// that it can be moved into from home (kinematics/hexapod/hexapod_global_forward.h).
std::vector<SolvedPose> solve_poses(const MachineDescription& machine,
                                    std::span<const kinematics::AxisVector> axes);

}  // namespace understudy::machine

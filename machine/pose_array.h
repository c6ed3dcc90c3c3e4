// Kinematics of many poses that stand as rows of plain numbers in somebody's memory, such as a NumPy array:
// read and answered in place, on all cores. A row of seven numbers is a pose X_WT: tip x y z [m], then the
// unit quaternion w x y z. Answers are those of a Mechanism's single call (pose_table.h). Not for control
// cycles.
#pragma once

#include <cstdint>
#include <span>

#include "kinematics/pose_row.h"
#include "machine/description.h"

namespace understudy::machine {

using kinematics::kPoseNumbers;

/// The statuses of a table's rows: kinematics::SolveStatus as one byte each.
using StatusBytes = std::span<std::uint8_t>;

/// Axes [m] or [rad] of each pose, near home. A row without an answer, or whose quaternion is none
/// (`bad_input`), is NaN. The spans hold 7, Mechanism::axis_count() and 1 number a row. `threads` 0: one for
/// each core; fewer where the rows are too few to be worth a thread.
void axes_of_poses(const MachineDescription& machine, std::span<const double> poses, std::span<double> axes,
                   StatusBytes status, int threads = 0);

/// The other way, seeded with home. Where a hexapod has no answer near
/// home, the assembly that it can be moved into from there.
void poses_of_axes(const MachineDescription& machine, std::span<const double> axes, std::span<double> poses,
                   StatusBytes status, int threads = 0);

}  // namespace understudy::machine

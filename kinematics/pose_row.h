// A pose as a row of seven plain numbers, as tables and NumPy arrays hold it: tip x y z [m], then the unit
// quaternion w x y z.
#pragma once

#include <cstddef>

#include "core/frames.h"

namespace understudy::kinematics {

constexpr std::size_t kPoseNumbers = 7;

/// A quaternion farther from length 1 is none, as in G-code.
constexpr double kUnitQuaternion = 1e-4;

/// The pose of a row. False where the quaternion is none.
bool read_pose(const double* row, Pose& X);
/// The row of a pose; w of the quaternion is not negative.
void write_pose(const Pose& X, double* row);

}  // namespace understudy::kinematics

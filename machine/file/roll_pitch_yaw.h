// Rotations as URDF writes them.
#pragma once

#include "core/frames.h"

namespace understudy::machine {

/// Angles of R = Rz(yaw) Ry(pitch) Rx(roll); roll from what yaw leaves, so that R stays exact where pitch is
/// a right angle.
Vec3 roll_pitch_yaw(const Mat3& R);

}  // namespace understudy::machine

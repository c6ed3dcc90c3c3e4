#include "machine/file/roll_pitch_yaw.h"

#include <cmath>

namespace understudy::machine {

Vec3 roll_pitch_yaw(const Mat3& R) {
  const double level = std::hypot(R(0, 0), R(1, 0));
  const double yaw = level > 1e-14 ? std::atan2(R(1, 0), R(0, 0)) : 0.0;
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, std::atan2(-R(2, 0), level), yaw};
}

}  // namespace understudy::machine

#include "drivers/pose_words.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"

namespace understudy::drivers {

using machine::AxisVector;

AxisVector pose_words(const Pose& X_BT) {
  const Mat3 R = X_BT.linear();
  const Vec3 p = X_BT.translation();
  return {p.x(),
          p.y(),
          p.z(),
          std::atan2(R(2, 1), R(2, 2)),
          std::atan2(0 - R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

PoseWords::PoseWords(const machine::MachineDescription& machine)
    : mechanism_(machine.make_mechanism()), last_(machine.X_BT_home) {
  if (machine.is_chain())
    throw InputError(machine.file.string() +
                     ": LinuxCNC's genhexkins is the kinematics of a hexapod, and this machine is none");
  deviation_ = machine.hexapod().geometry.deviation;
}

AxisVector PoseWords::of_axes(const AxisVector& axes) {
  Pose found;
  if (mechanism_->forward(std::span(axes).first(kPoseWords), last_, found) == kinematics::SolveStatus::ok)
    last_ = found;
  else
    lost_ = true;
  return pose_words(last_);
}

AxisVector PoseWords::axes_of_joints(const AxisVector& joints) const {
  AxisVector axes{};
  for (std::size_t i = 0; i < kPoseWords; ++i)
    axes[i] = std::sqrt(std::max(0., (joints[i] - deviation_) * (joints[i] + deviation_)));
  return axes;
}

AxisVector PoseWords::joints_of_axes(const AxisVector& axes) const {
  AxisVector joints{};
  for (std::size_t i = 0; i < kPoseWords; ++i) joints[i] = std::hypot(axes[i], deviation_);
  return joints;
}

}  // namespace understudy::drivers

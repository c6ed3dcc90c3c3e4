// What LinuxCNC's genhexkins calls the pose and the joints of a hexapod.
//
// Words are X Y Z [m] of the tip in the base's frame B and A B C [rad]: R_BT = Rz(C) Ry(B) Rx(A). A joint is
// the distance of base joint and ball joint; a strut that is driven beside the base joint is shorter:
// length^2 = distance^2 - dev^2 (docs/reference.md#hexapod-kinematics).
#pragma once

#include <memory>

#include "core/frames.h"
#include "machine/description.h"
#include "machine/port.h"

namespace understudy::drivers {

constexpr std::size_t kPoseWords = 6;  ///< and as many struts

machine::AxisVector pose_words(const Pose& X_BT);

class PoseWords {
 public:
  /// Throws InputError for a machine that is no hexapod. The description need not outlive this object.
  explicit PoseWords(const machine::MachineDescription& machine);

  /// The pose near the one that was asked for before (first: home). Where there is none, that one, and
  /// lost().
  machine::AxisVector of_axes(const machine::AxisVector& axes);
  bool lost() const { return lost_; }

  /// Strut lengths of joints, and back. [m]
  machine::AxisVector axes_of_joints(const machine::AxisVector& joints) const;
  machine::AxisVector joints_of_axes(const machine::AxisVector& axes) const;

 private:
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  double deviation_ = 0;  ///< [m]
  Pose last_;
  bool lost_ = false;
};

}  // namespace understudy::drivers

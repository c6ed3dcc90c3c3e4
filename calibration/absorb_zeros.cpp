#include "calibration/absorb_zeros.h"

#include <array>

namespace understudy::calibration {

kinematics::Chain absorb_zeros(const ChainParameters& machine) {
  std::vector<double> zero = machine.zero;
  zero.resize(machine.chain.axes.size(), 0.0);
  kinematics::PerAxis<Pose> links;
  kinematics::link_poses(machine.chain, zero, links);
  const auto link = [&](int axis) {
    return axis < 0 ? Pose::Identity() : links[static_cast<std::size_t>(axis)];
  };
  kinematics::Chain chain = machine.chain;
  for (kinematics::ChainAxis& axis : chain.axes) {
    axis.point = link(axis.parent) * axis.point;
    axis.direction = (link(axis.parent).linear() * axis.direction).normalized();
  }
  chain.X_OT_zero = link(chain.tool_axis) * chain.X_OT_zero;
  chain.X_OS_zero = link(chain.work_axis) * chain.X_OS_zero;
  return chain;
}

}  // namespace understudy::calibration

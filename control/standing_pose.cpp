#include "control/standing_pose.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::control {
namespace {

constexpr double kAtHome = 50e-6;  // [m or rad]: drives that rest at home read this or less beside it

}  // namespace

Pose standing_pose(const machine::MachineDescription& machine, const machine::MachinePort& port) {
  const auto mechanism = machine.make_mechanism();
  const auto axes = static_cast<std::size_t>(mechanism->axis_count());
  const kinematics::AxisVector measured = port.state().position;
  kinematics::AxisVector home{};
  const std::span<double> home_axes(home.data(), axes);
  bool at_home = mechanism->inverse(machine.X_BT_home, home_axes, home_axes) == kinematics::SolveStatus::ok;
  for (std::size_t i = 0; i < axes; ++i) at_home = at_home && std::abs(measured[i] - home[i]) <= kAtHome;
  if (at_home) return machine.X_WB * machine.X_BT_home;
  Pose X_BT;
  const kinematics::SolveStatus solved =
      mechanism->forward(std::span<const double>(measured.data(), axes), machine.X_BT_home, X_BT);
  if (solved != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format("the drives read axis positions that belong to no pose of the machine: {}",
                                   kinematics::to_string(solved)));
  return machine.X_WB * X_BT;
}

}  // namespace understudy::control

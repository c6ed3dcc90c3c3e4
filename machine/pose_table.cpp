#include "machine/pose_table.h"

#include <algorithm>

#include "kinematics/hexapod/hexapod_batch.h"
#include "kinematics/hexapod/hexapod_global_forward.h"

namespace understudy::machine {
namespace {

using kinematics::AxisVector;
using kinematics::Mechanism;
using kinematics::SolveStatus;
using kinematics::StrutLengths;

/// Axes are the lengths of struts, not drives behind screws that turn.
bool has_plain_struts(const HexapodModel& hexapod) {
  return hexapod.screw_rotation != ScrewRotation::compensated;
}

std::vector<SolvedAxes> one_by_one(const Mechanism& mechanism, std::span<const Pose> X_BT) {
  std::vector<SolvedAxes> solved(X_BT.size());
  std::ranges::transform(X_BT, solved.begin(), [&](const Pose& X) {
    SolvedAxes one;
    one.status = mechanism.inverse(X, {}, one.axes);
    return one;
  });
  return solved;
}

std::vector<SolvedPose> one_by_one(const Mechanism& mechanism, std::span<const AxisVector> axes) {
  std::vector<SolvedPose> solved(axes.size());
  std::ranges::transform(axes, solved.begin(), [&](const AxisVector& row) {
    SolvedPose one;
    one.status = mechanism.forward(row, mechanism.home(), one.X_BT);
    return one;
  });
  return solved;
}

StrutLengths strut_lengths(const AxisVector& axes) {
  StrutLengths lengths;
  std::copy_n(axes.begin(), lengths.size(), lengths.begin());
  return lengths;
}

std::vector<SolvedAxes> together(const HexapodModel& hexapod, std::span<const Pose> X_BT) {
  std::vector<StrutLengths> lengths(X_BT.size());
  std::vector<SolveStatus> status(X_BT.size(), SolveStatus::not_converged);
  kinematics::inverse_batch(hexapod.geometry, X_BT, lengths, status);
  std::vector<SolvedAxes> solved(X_BT.size());
  for (std::size_t i = 0; i < solved.size(); ++i) {
    solved[i].status = status[i];
    if (status[i] == SolveStatus::ok) std::ranges::copy(lengths[i], solved[i].axes.begin());
  }
  return solved;
}

std::vector<SolvedPose> together(const HexapodModel& hexapod, const Pose& X_BT_home,
                                 std::span<const AxisVector> axes) {
  std::vector<StrutLengths> lengths(axes.size());
  std::ranges::transform(axes, lengths.begin(), strut_lengths);
  const std::vector<Pose> seeds(axes.size(), X_BT_home);
  std::vector<kinematics::ForwardResult> results(axes.size());
  kinematics::forward_batch(hexapod.geometry, lengths, seeds, results);
  std::vector<SolvedPose> solved(axes.size());
  std::ranges::transform(results, solved.begin(), [](const kinematics::ForwardResult& result) {
    return result.status == SolveStatus::ok ? SolvedPose{result.status, result.X_BT}
                                            : SolvedPose{result.status};
  });
  return solved;
}

/// Once more from the pose that plain struts of these lengths would make: with screws that turn it is a
/// millimetre off at most.
void solve_far(const HexapodModel& hexapod, const Mechanism& mechanism, const AxisVector& axes,
               SolvedPose& solved) {
  const auto far =
      kinematics::forward_global(hexapod.geometry, strut_lengths(axes), mechanism.home(), mechanism.home());
  if (far.status == SolveStatus::ok) solved.status = mechanism.forward(axes, far.X_BT, solved.X_BT);
}

}  // namespace

std::vector<SolvedAxes> solve_axes(const MachineDescription& machine, std::span<const Pose> X_BT) {
  return machine.visit(
      [&](const HexapodModel& hexapod) {
        return has_plain_struts(hexapod) ? together(hexapod, X_BT)
                                         : one_by_one(*machine.make_mechanism(), X_BT);
      },
      [&](const ChainModel&) { return one_by_one(*machine.make_mechanism(), X_BT); });
}

std::vector<SolvedPose> solve_poses(const MachineDescription& machine, std::span<const AxisVector> axes) {
  const auto mechanism = machine.make_mechanism();
  return machine.visit(
      [&](const HexapodModel& hexapod) {
        std::vector<SolvedPose> solved = has_plain_struts(hexapod)
                                             ? together(hexapod, machine.X_BT_home, axes)
                                             : one_by_one(*mechanism, axes);
        for (std::size_t i = 0; i < solved.size(); ++i)
          if (solved[i].status != SolveStatus::ok) solve_far(hexapod, *mechanism, axes[i], solved[i]);
        return solved;
      },
      [&](const ChainModel&) { return one_by_one(*mechanism, axes); });
}

}  // namespace understudy::machine

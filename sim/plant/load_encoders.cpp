#include "sim/plant/load_encoders.h"

#include <Eigen/QR>
#include <cmath>

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;

constexpr int kIterations = 20;
constexpr double kConverged = 1e-10;   // [m] or [rad], of the last step: below any count
constexpr double kRadianWeighs = 0.1;  // [m], as in kinematics::ChainDescription::length_scale

}  // namespace

LoadEncoders::LoadEncoders(const machine::MachineDescription& machine, const AsBuilt& as_built,
                           const machine::LoadEncoderCounts& counts)
    : hexapod_(!machine.is_chain()),
      axes_(hexapod_ ? kinematics::kStruts : as_built.chain.size()),
      X_BW_(machine.X_WB.inverse()),
      struts_(as_built.hexapod),
      chain_(as_built.chain) {
  if (hexapod_ && machine.hexapod().screw_rotation == machine::ScrewRotation::compensated)
    coupling_ = machine.screw_coupling();
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes_); ++i) {
    count_[i] = counts.of(!hexapod_ && chain_.axes[i].angle);
    present_ = present_ && count_[i] > 0;
  }
}

/// Gauss and Newton: a chain of fewer axes than six makes the pose within rounding only.
bool LoadEncoders::chain_positions(const Pose& X_BT, AxisVector& positions) const {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kinematics::kMaxAxes>;
  kinematics::ChainJacobian columns;
  for (int k = 0; k < kIterations; ++k) {
    const Pose reached =
        kinematics::forward(chain_, std::span(positions).first(static_cast<std::size_t>(axes_)), columns);
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = X_BT.translation() - reached.translation();
    error.tail<3>() = kRadianWeighs * log_rotation(X_BT.linear() * reached.linear().transpose());
    Columns weighed = columns;
    weighed.bottomRows<3>() *= kRadianWeighs;
    const kinematics::AxisColumn step = weighed.completeOrthogonalDecomposition().solve(error);
    if (!step.allFinite()) return false;
    for (int i = 0; i < axes_; ++i) positions[static_cast<std::size_t>(i)] += step[i];
    if (step.cwiseAbs().maxCoeff() < kConverged) return true;
  }
  return false;
}

bool LoadEncoders::read(const Pose& X_WT, const AxisVector& near, AxisVector& positions) const {
  const Pose X_BT = X_BW_ * X_WT;
  AxisVector found = near;
  if (hexapod_) {
    kinematics::StrutLengths lengths{};
    if (kinematics::inverse(struts_, coupling_, X_BT, lengths) != SolveStatus::ok) return false;
    std::copy(lengths.begin(), lengths.end(), found.begin());
  } else if (!chain_positions(X_BT, found)) {
    return false;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes_); ++i)
    positions[i] = std::round(found[i] / count_[i]) * count_[i];
  return true;
}

}  // namespace understudy::sim

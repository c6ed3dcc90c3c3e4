#include "control/compensation/command_map.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/LU>

namespace understudy::control {

using kinematics::AxisVector;
using kinematics::elements;
using kinematics::SolveStatus;

namespace {

constexpr double kLeap = 0.1;          // [rad] or [m]: a calibration moves an axis by a tenth of that at most
constexpr double kTipReached = 1e-10;  // [m]
constexpr int kTipSteps = 8;           // each leaves the square of the last relative error
constexpr double kDifference = 1e-6;   // [m] or [rad], for a slope

}  // namespace

CommandMap::CommandMap(const machine::MachineDescription& nominal, const machine::MachineDescription& known)
    : nominal_(nominal.make_mechanism()),
      known_(known.make_mechanism()),
      X_WB_(nominal.X_WB),
      X_BW_(nominal.X_WB.inverse()),
      X_BT_command_(nominal.X_BT_home),
      X_BT_known_(known.X_BT_home) {
  elements(zero_) = elements(known.drive_zero()) - elements(nominal.drive_zero());
  static_cast<void>(nominal_->inverse(nominal.X_BT_home, {}, axes_));  // a home that is loaded can be taken
}

AxisVector CommandMap::shifted(const AxisVector& axes, double sign) const {
  AxisVector other;
  elements(other) = elements(axes) + sign * elements(zero_);
  return other;
}

SolveStatus CommandMap::nominal_axes(const Pose& X_WT, const std::optional<toolpath::RotaryTurns>& rotary) {
  const Pose X_BT = X_BW_ * X_WT;
  AxisVector axes = axes_, rates{};
  SolveStatus status = SolveStatus::ok;
  if (rotary)
    status = nominal_->axes_at_turns({X_BT.translation(), rotary->b, rotary->c}, {}, axes, rates);
  else
    status = nominal_->inverse(X_BT, axes_, axes);
  if (status == SolveStatus::ok) axes_ = axes;
  return status;
}

SolveStatus CommandMap::solve_known(const Pose& X_BT, const AxisVector& near, AxisVector& axes) const {
  const auto count = static_cast<std::size_t>(known_->axis_count());
  const SolveStatus status = known_->inverse(X_BT, std::span(near).first(count), axes);
  double leap = 0;
  for (std::size_t i = 0; i < count; ++i) leap = std::max(leap, std::abs(axes[i] - near[i]));
  if (status == SolveStatus::ok && leap < kLeap) return status;
  if (known_->follows_spin()) return status;
  axes = near;
  return put_tip_right(X_BT, axes);
}

/// By the axes that no rotary word turns; all of them where the machine has none.
SolveStatus CommandMap::put_tip_right(const Pose& X_BT, AxisVector& axes) const {
  std::vector<std::size_t> movable;
  for (int i = 0; i < known_->axis_count(); ++i)
    if (!known_->axis_is_angle(i)) movable.push_back(static_cast<std::size_t>(i));
  Eigen::MatrixXd slope(3, static_cast<Eigen::Index>(movable.size()));
  for (int step = 0; step < kTipSteps; ++step) {
    Pose at;
    if (const auto status = known_->forward(axes, X_BT, at); status != SolveStatus::ok) return status;
    const Vec3 off = X_BT.translation() - at.translation();
    if (off.norm() < kTipReached) return SolveStatus::ok;
    for (std::size_t k = 0; k < movable.size(); ++k) {
      AxisVector beside = axes;
      beside[movable[k]] += kDifference;
      Pose there;
      if (const auto status = known_->forward(beside, at, there); status != SolveStatus::ok) return status;
      slope.col(static_cast<Eigen::Index>(k)) = (there.translation() - at.translation()) / kDifference;
    }
    const Mat3 square = slope * slope.transpose();
    const Eigen::FullPivLU<Mat3> factors(square);
    if (!factors.isInvertible()) return SolveStatus::unreachable;
    const Eigen::VectorXd by = slope.transpose() * factors.solve(off);
    for (std::size_t k = 0; k < movable.size(); ++k) axes[movable[k]] += by[static_cast<Eigen::Index>(k)];
  }
  return SolveStatus::not_converged;
}

SolveStatus CommandMap::command(const Pose& X_WT, const std::optional<toolpath::RotaryTurns>& rotary,
                                NominalCommand& command) {
  if (const auto status = nominal_axes(X_WT, rotary); status != SolveStatus::ok) return status;
  AxisVector known{};
  if (const auto status = solve_known(X_BW_ * X_WT, shifted(axes_, 1), known); status != SolveStatus::ok)
    return status;
  const AxisVector asked = shifted(known, -1);
  Pose X_BT;
  if (const auto status = nominal_->forward(asked, X_BT_command_, X_BT); status != SolveStatus::ok)
    return status;
  X_BT_command_ = X_BT;
  command.X_WT = X_WB_ * X_BT;
  command.rotary.reset();
  if (!rotary) return SolveStatus::ok;
  const auto words = nominal_->rotary_words();
  const auto reading = [&](std::size_t word, double said) {
    return word < words.size() ? words[word].reading(asked) : said;
  };
  command.rotary = {reading(0, rotary->b), reading(1, rotary->c)};
  return SolveStatus::ok;
}

SolveStatus CommandMap::tool_at(const AxisVector& nominal_axes, Pose& X_WT) {
  Pose X_BT;
  const auto status = known_->forward(shifted(nominal_axes, 1), X_BT_known_, X_BT);
  if (status != SolveStatus::ok) return status;
  X_BT_known_ = X_BT;
  X_WT = X_WB_ * X_BT;
  return status;
}

}  // namespace understudy::control

#include "kinematics/chain/chain_mechanism.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chain/task_jacobian.h"

namespace understudy::kinematics {
namespace {

/// From twists to the task: all six, or without the turn about the tool's axis. Angles as lengths.
TaskRows task_rows(const Pose& X_ST, bool follows_spin, double length_scale) {
  TaskRows rows = TaskRows::Zero(follows_spin ? 6 : 5, 6);
  rows.topLeftCorner<3, 3>().setIdentity();
  if (follows_spin) {
    rows.bottomRightCorner<3, 3>() = length_scale * Mat3::Identity();
  } else {
    rows.block<1, 3>(3, 3) = length_scale * X_ST.linear().col(0).transpose();
    rows.block<1, 3>(4, 3) = length_scale * X_ST.linear().col(1).transpose();
  }
  return rows;
}

/// Task per axis, angles as lengths on both sides.
TaskJacobian scaled_jacobian(const Chain& chain, const TaskRows& rows, const ChainJacobian& J,
                             double length_scale) {
  TaskJacobian scaled = rows * J;
  for (int i = 0; i < chain.size(); ++i)
    if (chain.axes[i].angle) scaled.col(i) /= length_scale;
  return scaled;
}

bool finite(std::span<const double> values) {
  for (const double v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

}  // namespace

double nearest_turn(double angle, double near) {
  constexpr double kTurn = 2 * std::numbers::pi;
  if (std::abs(near - angle) <= kTurn / 2) return angle;
  return angle + kTurn * std::round((near - angle) / kTurn);
}

double nearest_turn(double angle, double near, AxisRange range) {
  const double nearest = nearest_turn(angle, near);
  if (nearest >= range.lower && nearest <= range.upper) return nearest;
  // The turn nearest `near` within the range is the first one inside the end that was passed.
  constexpr double kTurn = 2 * std::numbers::pi;
  const double inside = nearest < range.lower ? nearest + kTurn * std::ceil((range.lower - nearest) / kTurn)
                                              : nearest - kTurn * std::ceil((nearest - range.upper) / kTurn);
  return inside >= range.lower && inside <= range.upper ? inside : nearest;
}

bool is_pose(const Pose& X) {
  constexpr double kTolerance = 1e-6;
  const auto x = X.linear().col(0), y = X.linear().col(1), z = X.linear().col(2);
  const auto off = [](double v) { return !(std::abs(v - 1) <= kTolerance); };  // also where v is NaN
  if (off(x.squaredNorm()) || off(y.squaredNorm()) || off(z.squaredNorm()) || off(x.cross(y).dot(z)))
    return false;
  return X.translation().allFinite();
}

ChainMechanism::ChainMechanism(const ChainDescription& description, bool follows_spin)
    : description_(description),
      follows_spin_(follows_spin),
      X_ST_home_(kinematics::forward(description_.chain, description_.home)),
      turns_(description_.turn_words.empty() ? nullptr : std::make_unique<ChainTurns>(description_)) {}

std::string ChainMechanism::axis_name(int axis) const { return chain_.axes[axis].name; }
bool ChainMechanism::axis_is_angle(int axis) const { return chain_.axes[axis].angle; }
AxisRange ChainMechanism::axis_range(int axis) const {
  const ChainAxis& a = chain_.axes[axis];
  return {a.lower, a.upper};
}

std::span<const double> ChainMechanism::near(std::span<const double> previous) const {
  return previous.size() >= chain_.axes.size() ? previous : std::span<const double>(description_.home);
}

bool ChainMechanism::usable(std::span<const double> previous) const {
  return previous.size() < chain_.axes.size() || finite(previous.first(chain_.axes.size()));
}

bool ChainMechanism::settle(std::span<const double> previous, std::span<double> axes) const {
  const std::span<const double> beside = near(previous);
  for (std::size_t i = 0; i < chain_.axes.size(); ++i)
    if (chain_.axes[i].angle) axes[i] = nearest_turn(axes[i], beside[i]);
  if (continues(previous, axes)) return true;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i)
    if (chain_.axes[i].angle)
      axes[i] = nearest_turn(axes[i], beside[i], {chain_.axes[i].lower, chain_.axes[i].upper});
  return within_ranges(axes);
}

bool ChainMechanism::within_ranges(std::span<const double> axes) const {
  for (std::size_t i = 0; i < chain_.axes.size(); ++i)
    if (axes[i] < chain_.axes[i].lower || axes[i] > chain_.axes[i].upper) return false;
  return true;
}

double ChainMechanism::distance2(std::span<const double> a, std::span<const double> b) const {
  double sum = 0;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) {
    const double weight = chain_.axes[i].angle ? description_.length_scale : 1;
    sum += weight * weight * (a[i] - b[i]) * (a[i] - b[i]);
  }
  return sum;
}

bool ChainMechanism::continues(std::span<const double> previous, std::span<const double> axes) const {
  constexpr double kStep = 0.2;  // [rad]; a planner's samples are far nearer, other branches seldom so near
  if (previous.size() < chain_.axes.size()) return false;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i)
    if (chain_.axes[i].angle && std::abs(axes[i] - previous[i]) > kStep) return false;
  return true;
}

SolveStatus ChainMechanism::forward(std::span<const double> axes, const Pose&, Pose& X_ST) const {
  if (axes.size() < chain_.axes.size() || !finite(axes.first(chain_.axes.size())))
    return SolveStatus::bad_input;
  X_ST = kinematics::forward(chain_, axes);
  return SolveStatus::ok;
}

SolveStatus ChainMechanism::axis_rates(const Pose& X_ST, std::span<const double> axes,
                                       Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const {
  const auto n = chain_.size();
  if (axes.size() < chain_.axes.size() || rates.rows() < n || !is_pose(X_ST) ||
      !finite(axes.first(chain_.axes.size())))
    return SolveStatus::bad_input;
  ChainJacobian J;
  kinematics::forward(chain_, axes, J);
  const double scale = description_.length_scale;
  const TaskRows rows = task_rows(X_ST, follows_spin_, scale);
  const TaskJacobian scaled = scaled_jacobian(chain_, rows, J, scale);
  AxisRows solution;
  const bool full_rank = solve_minimum_norm(scaled, rows, solution);
  rates.topRows(n) = solution;
  for (int i = 0; i < n; ++i)
    if (chain_.axes[i].angle) rates.row(i) /= scale;
  return full_rank ? SolveStatus::ok : SolveStatus::singular;
}

double ChainMechanism::condition_number(const Pose& X_ST, std::span<const double> axes) const {
  if (axes.size() < chain_.axes.size() || !is_pose(X_ST) || !finite(axes.first(chain_.axes.size())))
    return kSingularCondition;
  ChainJacobian J;
  kinematics::forward(chain_, axes, J);
  const double scale = description_.length_scale;
  const TaskRows rows = task_rows(X_ST, follows_spin_, scale);
  return kinematics::condition_number(scaled_jacobian(chain_, rows, J, scale), kSingularCondition);
}

void ChainMechanism::check(const Pose& X_ST, std::span<const double> axes,
                           std::vector<LimitViolation>& violations) const {
  if (axes.size() < chain_.axes.size()) {
    violations.push_back({LimitKind::unreachable, "tool pose", 0, 0, ""});
    return;
  }
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) {
    const ChainAxis& axis = chain_.axes[i];
    const double limit = axes[i] < axis.lower ? axis.lower : axis.upper;
    if (axes[i] >= axis.lower && axes[i] <= axis.upper) continue;
    violations.push_back(
        {LimitKind::joint_limit, "axis " + axis.name, axes[i], limit, axis.angle ? "rad" : "m"});
  }
  if (description_.condition_max == kEndless) return;
  const double condition = condition_number(X_ST, axes);
  if (condition > description_.condition_max)
    violations.push_back({LimitKind::singularity, "tool pose", condition, description_.condition_max, "1"});
}

bool ChainMechanism::can_turn(const RotaryTarget& at) const {
  return turns_ != nullptr && at.p_BT.allFinite() && std::isfinite(at.b) && std::isfinite(at.c);
}

SolveStatus ChainMechanism::pose_at_turns(const RotaryTarget& at, Pose& X_ST) const {
  return can_turn(at) ? turns_->pose_at_turns(at, X_ST) : SolveStatus::bad_input;
}

SolveStatus ChainMechanism::parts_at_turns(const RotaryTarget& at, Mat3& table, Mat3& head) const {
  if (!can_turn(at)) return SolveStatus::bad_input;
  turns_->parts_at_turns(at, table, head);
  return SolveStatus::ok;
}

SolveStatus ChainMechanism::pose_at_slides(const RotaryTarget& at, Pose& X_ST) const {
  return can_turn(at) ? turns_->pose_at_slides(at, X_ST) : SolveStatus::bad_input;
}

SolveStatus ChainMechanism::slides_at_turns(const RotaryTarget& at, Vec3& slides) const {
  return can_turn(at) ? turns_->slides_at_turns(at, slides) : SolveStatus::bad_input;
}

SolveStatus ChainMechanism::axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate,
                                          std::span<double> axes, std::span<double> axis_rates) const {
  const std::size_t n = chain_.axes.size();
  if (!can_turn(at) || !can_turn(rate) || axes.size() < n || axis_rates.size() < n)
    return SolveStatus::bad_input;
  return turns_->axes_at_turns(at, rate, axes, axis_rates);
}

}  // namespace understudy::kinematics

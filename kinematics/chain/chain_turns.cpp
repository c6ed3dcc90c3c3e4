#include "kinematics/chain/chain_turns.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace understudy::kinematics {
namespace {

constexpr double kFlat = 1e-6;  // of the determinant of three slides' directions: they lie in a plane

bool is_turned(const ChainDescription& description, std::size_t axis) {
  return std::ranges::count(description.turn_words, axis, &AxisWord::axis) > 0;
}

/// The axes that no word turns, in the order of the chain.
std::vector<std::size_t> followers(const ChainDescription& description) {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < description.chain.axes.size(); ++i)
    if (!is_turned(description, i)) axes.push_back(i);
  return axes;
}

bool three_slides(const Chain& chain, const std::vector<std::size_t>& axes) {
  return axes.size() == 3 && std::ranges::none_of(axes, [&](std::size_t i) { return chain.axes[i].angle; });
}

/// Whether the axis carries what `last` carries.
bool carries(const Chain& chain, std::size_t axis, int last) {
  for (int i = last; i >= 0; i = chain.axes[static_cast<std::size_t>(i)].parent)
    if (static_cast<std::size_t>(i) == axis) return true;
  return false;
}

/// The tool's branch as a chain of its own, told from O.
ChainDescription arm_of(const ChainDescription& whole, const std::vector<std::size_t>& axes) {
  ChainDescription arm;
  arm.kind = "chain";
  arm.length_scale = whole.length_scale;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    ChainAxis axis = whole.chain.axes[axes[k]];
    axis.parent = static_cast<int>(k) - 1;  // a branch is a row
    arm.chain.axes.push_back(axis);
    arm.home[k] = whole.home[axes[k]];
  }
  arm.chain.tool_axis = arm.chain.size() - 1;
  arm.chain.X_OT_zero = whole.chain.X_OT_zero;
  return arm;
}

Pose carried(std::span<const Pose> links, int axis, const Pose& at_zero) {
  return axis < 0 ? at_zero : Pose(links[static_cast<std::size_t>(axis)] * at_zero);
}

struct Ends {
  Pose X_OT, X_OS;
};
Ends ends(const Chain& chain, std::span<const double> axes) {
  PerAxis<Pose> links;
  link_poses(chain, axes, links);
  return {carried(links, chain.tool_axis, chain.X_OT_zero), carried(links, chain.work_axis, chain.X_OS_zero)};
}

}  // namespace

std::string turns_problem(const ChainDescription& description) {
  const Chain& chain = description.chain;
  const std::vector<std::size_t> axes = followers(description);
  if (three_slides(chain, axes)) {
    ChainJacobian J;
    forward(chain, description.home, J);
    Mat3 columns;
    for (int i = 0; i < 3; ++i)
      columns.col(i) = J.col(static_cast<Eigen::Index>(axes[static_cast<std::size_t>(i)])).head<3>();
    return std::abs(columns.determinant()) > kFlat
               ? ""
               : "the three slides that no word drives lie in one plane: they cannot place the tip";
  }
  for (const AxisWord& word : description.turn_words)
    if (!carries(chain, word.axis, chain.work_axis) || carries(chain, word.axis, chain.tool_axis))
      return "axis " + chain.axes[word.axis].name +
             " carries the tool, and the axes that no word drives are not three slides: which of them "
             "place the tip is not told";
  for (const std::size_t axis : axes)
    if (!carries(chain, axis, chain.tool_axis) || carries(chain, axis, chain.work_axis))
      return "axis " + chain.axes[axis].name + " has no word and does not carry the tool alone";
  return axes.size() >= 3 ? "" : "fewer than three axes are left to place the tip";
}

ChainTurns::ChainTurns(const ChainDescription& description)
    : description_(description),
      chain_(description.chain),
      X_OT_home_(ends(description.chain, description.home).X_OT) {
  const std::vector<std::size_t> axes = followers(description);
  if (three_slides(chain_, axes)) {
    std::ranges::copy(axes, follow_.begin());
    return;
  }
  arm_axes_ = axes;
  arm_ = make_chain_mechanism(arm_of(description, axes));
}

AxisVector ChainTurns::turned(const RotaryTarget& at) const {
  AxisVector axes = description_.home;
  if (!arm_)
    for (const std::size_t i : follow_) axes[i] = 0;
  const double readings[] = {at.b, at.c};
  for (std::size_t k = 0; k < description_.turn_words.size(); ++k)
    axes[description_.turn_words[k].axis] = description_.turn_words[k].position(readings[k]);
  return axes;
}

AxisVector ChainTurns::word_rates(const RotaryTarget& rate) const {
  AxisVector rates{};
  const double readings[] = {rate.b, rate.c};
  for (std::size_t k = 0; k < description_.turn_words.size(); ++k)
    rates[description_.turn_words[k].axis] = description_.turn_words[k].sign * readings[k];
  return rates;
}

Mat3 ChainTurns::slide_columns(const ChainJacobian& jacobian) const {
  Mat3 columns;
  for (std::size_t i = 0; i < 3; ++i)
    columns.col(static_cast<Eigen::Index>(i)) = jacobian.col(static_cast<Eigen::Index>(follow_[i])).head<3>();
  return columns;
}

void ChainTurns::parts_at_turns(const RotaryTarget& at, Mat3& table, Mat3& head) const {
  const Ends now = ends(chain_, turned(at)), zero = ends(chain_, AxisVector{});
  const Mat3 R_OS = zero.X_OS.linear();
  table = now.X_OS.linear().transpose() * R_OS;
  if (arm_)
    head.setIdentity();
  else
    head = R_OS.transpose() * now.X_OT.linear() * zero.X_OT.linear().transpose() * R_OS;
}

SolveStatus ChainTurns::pose_at_turns(const RotaryTarget& at, Pose& X_ST) const {
  const Ends turned_to = ends(chain_, turned(at));
  const Mat3& R_OT = arm_ ? X_OT_home_.linear() : turned_to.X_OT.linear();
  X_ST = make_pose(Mat3(turned_to.X_OS.linear().transpose() * R_OT), at.p_BT);
  return SolveStatus::ok;
}

SolveStatus ChainTurns::pose_at_slides(const RotaryTarget& at, Pose& X_ST) const {
  if (description_.slide_words.empty()) return SolveStatus::bad_input;
  AxisVector axes = turned(at);
  for (int i = 0; i < 3; ++i) {
    const AxisWord& word = description_.slide_words[static_cast<std::size_t>(i)];
    axes[word.axis] = word.position(at.p_BT[i]);
  }
  X_ST = forward(chain_, axes);
  return SolveStatus::ok;
}

SolveStatus ChainTurns::slides_at_turns(const RotaryTarget& at, Vec3& slides) const {
  if (description_.slide_words.empty()) return SolveStatus::bad_input;
  AxisVector axes{}, rates{};
  const SolveStatus status = follow_by_slides(at, {}, axes, rates);
  for (std::size_t i = 0; i < 3; ++i)
    slides[static_cast<Eigen::Index>(i)] = description_.slide_words[i].reading(axes);
  return status;
}

SolveStatus ChainTurns::axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate,
                                      std::span<double> axes, std::span<double> axis_rates) const {
  return arm_ ? follow_by_arm(at, rate, axes, axis_rates) : follow_by_slides(at, rate, axes, axis_rates);
}

SolveStatus ChainTurns::follow_by_slides(const RotaryTarget& at, const RotaryTarget& rate,
                                         std::span<double> axes, std::span<double> axis_rates) const {
  const std::size_t n = chain_.axes.size();
  AxisVector q = turned(at), q_rate = word_rates(rate);
  ChainJacobian J;
  const Pose X_ST = forward(chain_, q, J);
  const Eigen::PartialPivLU<Mat3> columns(slide_columns(J));
  const Vec3 slides = columns.solve(at.p_BT - X_ST.translation());
  for (std::size_t i = 0; i < 3; ++i) q[follow_[i]] = slides[static_cast<Eigen::Index>(i)];
  forward(chain_, q, J);  // what a turn does to the tip depends on where the slides are
  Vec3 left = rate.p_BT;
  for (const AxisWord& word : description_.turn_words)
    left -= J.col(static_cast<Eigen::Index>(word.axis)).head<3>() * q_rate[word.axis];
  const Vec3 slide_rates = columns.solve(left);
  for (std::size_t i = 0; i < 3; ++i) q_rate[follow_[i]] = slide_rates[static_cast<Eigen::Index>(i)];
  std::copy_n(q.begin(), n, axes.begin());
  std::copy_n(q_rate.begin(), n, axis_rates.begin());
  return SolveStatus::ok;
}

SolveStatus ChainTurns::follow_by_arm(const RotaryTarget& at, const RotaryTarget& rate,
                                      std::span<double> axes, std::span<double> axis_rates) const {
  const AxisVector table = turned(at), table_rates = word_rates(rate);
  const std::size_t n = arm_axes_.size();
  const Pose X_OS = ends(chain_, table).X_OS;
  const Pose X_OT = make_pose(Mat3(X_OT_home_.linear()), Vec3(X_OS * at.p_BT));
  AxisVector q{};
  for (std::size_t k = 0; k < n; ++k) q[k] = axes[arm_axes_[k]];
  if (const SolveStatus status = arm_->inverse(X_OT, std::span(q).first(n), q); status != SolveStatus::ok)
    return status;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxAxes, 6> rates(static_cast<Eigen::Index>(n), 6);
  if (const SolveStatus status = arm_->axis_rates(X_OT, q, rates); status != SolveStatus::ok) return status;
  for (const AxisWord& word : description_.turn_words) {
    axes[word.axis] = table[word.axis];
    axis_rates[word.axis] = table_rates[word.axis];
  }
  // The point of the table below the tip carries it along; the tool does not turn.
  PerAxis<Pose> links;
  link_poses(chain_, table, links);
  Vec3 v_O = X_OS.linear() * rate.p_BT;
  for (const AxisWord& word : description_.turn_words) {
    const ChainAxis& axis = chain_.axes[word.axis];
    const Vec3 direction = links[word.axis].linear() * axis.direction;
    v_O += table_rates[word.axis] * direction.cross(X_OT.translation() - links[word.axis] * axis.point);
  }
  for (std::size_t k = 0; k < n; ++k) {
    axes[arm_axes_[k]] = q[k];
    axis_rates[arm_axes_[k]] = rates.row(static_cast<Eigen::Index>(k)).head<3>().dot(v_O);
  }
  return SolveStatus::ok;
}

}  // namespace understudy::kinematics

#include "control/path_segment.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {

using kinematics::Solve;
using toolpath::StepKind;

namespace {

constexpr double kRigidTolerance = 1e-6;  // of R^T R - I

[[noreturn]] void refuse(int line, const std::string& message) {
  throw InputError(Place{"", line, 0}, "line " + std::to_string(line) + ": " + message);
}

void require_pose(const toolpath::Step& step) {
  if (!step.X_WT.matrix().allFinite()) refuse(step.line, "the pose is not finite");
  const Mat3 R = step.X_WT.linear();
  if ((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() > kRigidTolerance || R.determinant() < 0)
    refuse(step.line, "the orientation is not a rotation");
}

void require_figures(const toolpath::Step& step) {
  if (!std::isfinite(step.duration) || step.duration < 0)
    refuse(step.line, "duration is " + std::to_string(step.duration) + " s, must be 0 or more");
  if (!std::isfinite(step.filament)) refuse(step.line, "the filament's length is not finite");
}

double linear_speed(const toolpath::Step& step, const MotionLimits& limits) {
  if (step.kind == StepKind::travel || step.kind == StepKind::home) return limits.travel_velocity;
  if (!(step.feed > 0) || !std::isfinite(step.feed))
    refuse(step.line, "feed is " + std::to_string(to_mm(step.feed)) + " mm/s, must be above 0");
  return step.feed;
}

// Speed of s: the programmed speed of the tip, or the inverse time of G93, within the tool's angular speed.
double path_speed(const toolpath::Step& step, const PathSegment& segment, const MotionLimits& limits) {
  double speed = std::numeric_limits<double>::infinity();
  const double travel = segment.travel.norm();
  if (step.duration > 0)
    speed = segment.length / step.duration;
  else if (const double tip_speed = linear_speed(step, limits); travel > 0)
    speed = tip_speed * (segment.length / travel);
  if (segment.turn > 0)
    speed = std::min(speed, limits.orientation_velocity * (segment.length / segment.turn));
  return speed;
}

}  // namespace

Pose PathSegment::pose_at(double s) const {
  if (s >= length) return X_WT_end;
  const double t = s / length;
  Pose X = X_WT_begin;
  X.translation() += t * travel;
  if (turn > 0) X.linear() = X_WT_begin.linear() * Eigen::AngleAxisd(t * turn, turn_axis).toRotationMatrix();
  return X;
}

Twist PathSegment::twist_W() const {
  Twist twist;
  twist << travel / length, X_WT_begin.linear() * turn_axis * (turn / length);
  return twist;
}

double PathSegment::filament_at(double fraction) const {
  if (fraction >= 1) return filament_end;
  return filament_begin + fraction * (filament_end - filament_begin);
}

PathSegment make_segment(const toolpath::Step& step, const Pose& X_WT_begin, const MotionLimits& limits) {
  require_figures(step);
  PathSegment segment;
  segment.line = step.line;
  segment.X_WT_begin = segment.X_WT_end = X_WT_begin;
  segment.filament_end = step.filament;
  if (toolpath::moves(step)) {
    require_pose(step);
    const Vec3 travel = step.X_WT.translation() - X_WT_begin.translation();
    const Vec3 turn = log_rotation(X_WT_begin.linear().transpose() * step.X_WT.linear());
    const double length = std::max(travel.norm(), kTurnRadius * turn.norm());
    if (length > kShortestPath) {
      segment.X_WT_end = step.X_WT;
      segment.travel = travel;
      segment.turn = turn.norm();
      if (segment.turn > 0) segment.turn_axis = turn / segment.turn;
      segment.length = length;
      segment.speed = path_speed(step, segment, limits);
      return segment;
    }
  }
  segment.rest = step.duration;
  if (step.duration == 0 && step.filament != 0)
    segment.rest = std::abs(step.filament) / linear_speed(step, limits);
  return segment;
}

int parts_of(const PathSegment& segment, double travel, double turn) {
  const double parts = std::max(segment.length / travel, segment.turn / turn);
  return std::max(1, static_cast<int>(std::ceil(parts - 1e-9)));
}

PathKinematics::PathKinematics(const kinematics::Mechanism& mechanism, const Pose& X_WB)
    : mechanism_(mechanism), X_BW_(X_WB.inverse()), axis_count_(mechanism.axis_count()) {}

Solve PathKinematics::axes(const Pose& X_WT, machine::AxisArray& position) const {
  return mechanism_.inverse(X_BW_ * X_WT, position, position);
}

Solve PathKinematics::evaluate(const PathSegment& segment, double s, machine::AxisArray& position,
                               ChannelArray& slope) const {
  slope.fill(0);
  if (segment.self_motion) return evaluate_self_motion(segment, s, position, slope);
  const Pose X_WT = segment.moves() ? segment.pose_at(s) : segment.X_WT_end;
  const Pose X_BT = X_BW_ * X_WT;
  Solve status = mechanism_.inverse(X_BT, position, position);
  if (status != Solve::ok || !segment.moves()) return status;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, machine::kMaxAxes, 6> rates(axis_count_, 6);
  status = mechanism_.axis_rates(X_BT, position, rates);
  // A five-axis table is singular wherever its tool stands upright, and prints there all the same; where the
  // way leads out of such a pose, a self-motion comes first.
  if (status != Solve::ok && (mechanism_.follows_spin() || status != Solve::singular)) return status;
  const Twist twist_W = segment.twist_W();
  Twist twist_B;
  twist_B << X_BW_.linear() * twist_W.head<3>(), X_BW_.linear() * twist_W.tail<3>();
  for (int i = 0; i < axis_count_; ++i) slope[static_cast<std::size_t>(i)] = rates.row(i).dot(twist_B);
  slope[static_cast<std::size_t>(axis_count_)] = twist_W.head<3>().norm();
  return Solve::ok;
}

/// The free axis goes straight from one end to the other; the inverse lets it, and moves the rest with it.
Solve PathKinematics::evaluate_self_motion(const PathSegment& segment, double s, machine::AxisArray& position,
                                           ChannelArray& slope) const {
  const Pose X_BT = X_BW_ * segment.X_WT_begin;
  const auto at = [&](double share, machine::AxisArray& axes) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i] = (1 - share) * segment.self_motion->from[i] + share * segment.self_motion->to[i];
    return mechanism_.inverse(X_BT, axes, axes);
  };
  constexpr double kStep = 1e-5;  // of the motion: far above rounding, far below what bends
  machine::AxisArray before{}, after{};
  const double share = s / segment.length;
  for (const Solve status : {at(share - kStep, before), at(share + kStep, after), at(share, position)})
    if (status != Solve::ok) return status;
  for (std::size_t i = 0; i < static_cast<std::size_t>(axis_count_); ++i)
    slope[i] = (after[i] - before[i]) / (2 * kStep * segment.length);
  return Solve::ok;
}

std::pair<int, double> PathKinematics::largest_turn(const machine::AxisArray& from,
                                                    const machine::AxisArray& to) const {
  std::pair<int, double> largest{0, 0.0};
  for (int i = 0; i < axis_count_; ++i) {
    const double turn = std::abs(to[static_cast<std::size_t>(i)] - from[static_cast<std::size_t>(i)]);
    if (mechanism_.axis_is_angle(i) && turn > largest.second) largest = {i, turn};
  }
  return largest;
}

std::optional<PathSegment> PathKinematics::self_motion_before(const PathSegment& segment,
                                                              const machine::AxisArray& position) const {
  constexpr double kAhead = 1e-3;    // of a segment: there its way has shown which axes it needs
  constexpr double kSettled = 0.02;  // [rad], what an axis may move up to there without a turn of its own
  if (mechanism_.follows_spin() || !segment.moves() || segment.turn == 0) return std::nullopt;
  machine::AxisArray from = position, to = position;
  if (axes(segment.X_WT_begin, from) != Solve::ok ||
      axes(segment.pose_at(kAhead * segment.length), to) != Solve::ok)
    return std::nullopt;
  if (largest_turn(from, to).second <= kSettled) return std::nullopt;
  if (axes(segment.X_WT_begin, to) != Solve::ok) return std::nullopt;
  const double turn = largest_turn(from, to).second;
  if (turn <= kSettled) return std::nullopt;  // nothing is free here: the pose needs the axes where they are
  PathSegment motion;
  motion.line = segment.line;
  motion.step = segment.step;
  motion.X_WT_begin = motion.X_WT_end = segment.X_WT_begin;
  motion.self_motion = {from, to};
  motion.length = kTurnRadius * turn;
  motion.speed = std::numeric_limits<double>::infinity();  // as fast as the axes are
  return motion;
}

void PathKinematics::require_reachable(PathSegment& segment, PoseCheck check,
                                       machine::AxisArray& position) const {
  // An axis turns fast near a singular pose. Condition numbers grow as the way nears it, so that coarse looks
  // tell where finer ones are needed.
  constexpr double kNear = 20;    // condition number of a pose that is well away from it
  constexpr double kFinest = 64;  // 0.02 degrees of the tool
  const machine::AxisArray begin = position;
  for (int fineness = 1;;) {
    segment.fineness = fineness;
    position = begin;
    const Walk seen = walk(segment, check, position);
    fineness = static_cast<int>(std::clamp(seen.condition / kNear, 1.0, kFinest));
    if (fineness > segment.fineness) continue;
    if (seen.leap > kLeap)
      refuse(segment.line, "axis " + mechanism_.axis_name(seen.leaping_axis) + " would leap by " +
                               std::to_string(to_deg(seen.leap)) +
                               " deg: the way passes too near a singular pose");
    return;
  }
}

PathKinematics::Walk PathKinematics::walk(const PathSegment& segment, PoseCheck check,
                                          machine::AxisArray& position) const {
  std::vector<kinematics::LimitViolation> violations;
  const auto require = [&](double s, machine::AxisArray& near) {
    ChannelArray slope{};
    const Pose X_WT = segment.self_motion ? segment.X_WT_begin : segment.pose_at(s);
    const Solve status = segment.self_motion ? evaluate(segment, s, near, slope) : axes(X_WT, near);
    const std::span<const double> solution = near;
    if (status != Solve::ok || check == PoseCheck::limits)
      mechanism_.check(X_BW_ * X_WT, status == Solve::ok ? solution : std::span<const double>(), violations);
    if (!violations.empty()) refuse(segment.line, to_string(violations.front()));
    if (status != Solve::ok) refuse(segment.line, std::string("the pose is ") + to_string(status));
  };
  const bool may_pass = !mechanism_.follows_spin() && !segment.self_motion && segment.turn > 0;
  const int parts = segment.self_motion
                        ? std::max(1, static_cast<int>(std::ceil(segment.length / kTurnRadius / kCheckTurn)))
                        : segment.fineness * parts_of(segment, kCheckTravel, kCheckTurn);
  machine::AxisArray end = position;
  require(segment.length, end);  // the programmed pose before those on the way to it
  Walk seen;
  for (int k = 1; k <= parts; ++k) {
    const machine::AxisArray before = position;
    const double s = segment.length * k / parts;
    require(s, position);
    if (may_pass)
      seen.condition =
          std::max(seen.condition, mechanism_.condition_number(X_BW_ * segment.pose_at(s), position));
    if (const auto [axis, turn] = largest_turn(before, position); turn > seen.leap) {
      seen.leap = turn;
      seen.leaping_axis = axis;
    }
  }
  return seen;
}

}  // namespace understudy::control

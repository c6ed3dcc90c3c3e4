#include "control/motion/path_kinematics.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {

using kinematics::SolveStatus;

namespace {

constexpr double kSamePose = 1e-6;  // between tool axes, of a pose and of the turns that it was made of

}  // namespace

PathKinematics::PathKinematics(const kinematics::Mechanism& mechanism, const Pose& X_WB)
    : mechanism_(mechanism),
      X_WB_(X_WB),
      X_BW_(X_WB.inverse()),
      axis_count_(mechanism.axis_count()),
      rotary_words_(mechanism.rotary_words()) {}

PathSegment PathKinematics::segment(const toolpath::Step& step, const Pose& X_WT_begin,
                                    const kinematics::AxisVector& axes_begin,
                                    const MotionLimits& limits) const {
  const bool moves = toolpath::moves(step);
  if (moves && step.rotary) require_turns(step);
  std::optional<PathSegment::Rotary> rotary;
  if (!rotary_words_.empty()) {
    const toolpath::RotaryTurns from{rotary_words_[0].reading(axes_begin),
                                     rotary_words_.size() > 1 ? rotary_words_[1].reading(axes_begin) : 0};
    if (!moves || step.rotary) rotary = {from, moves ? *step.rotary : from};
  }
  return make_segment(step, X_WT_begin, rotary, limits);
}

void PathKinematics::require_turns(const toolpath::Step& step) const {
  if (rotary_words_.empty()) refuse(step.line, "rotary words on a machine without rotary axes");
  Pose X_BT;
  if (mechanism_.pose_at_turns({X_BW_ * step.X_WT.translation(), step.rotary->b, step.rotary->c}, X_BT) !=
      SolveStatus::ok)
    refuse(step.line, "a rotary word is not finite");
  if ((tool_axis(X_WB_ * X_BT) - tool_axis(step.X_WT)).norm() > kSamePose)
    refuse(step.line, "the pose is not the one that the rotary words make");
}

SolveStatus PathKinematics::axes(const Pose& X_WT, kinematics::AxisVector& position) const {
  return mechanism_.inverse(X_BW_ * X_WT, position, position);
}

kinematics::RotaryTarget PathKinematics::turned_tip(const PathSegment& segment, double s) const {
  const toolpath::RotaryTurns turns = segment.turns_at(s);
  return {X_BW_ * segment.tip_at(s), turns.b, turns.c};
}

Pose PathKinematics::pose_at(const PathSegment& segment, double s) const {
  if (segment.self_motion) return segment.X_WT_begin;
  if (s >= segment.length) return segment.X_WT_end;
  Pose X = segment.X_WT_begin;
  if (segment.rotary) {
    Pose X_BT;
    if (mechanism_.pose_at_turns(turned_tip(segment, s), X_BT) != SolveStatus::ok) return segment.X_WT_end;
    X.linear() = (X_WB_ * X_BT).linear();
  } else if (segment.turn > 0) {
    const double angle = s / segment.length * segment.turn;
    X.linear() = X.linear() * Eigen::AngleAxisd(angle, segment.turn_axis).toRotationMatrix();
  }
  X.translation() = segment.tip_at(s);
  return X;
}

SolveStatus PathKinematics::axes_at(const PathSegment& segment, double s,
                                    kinematics::AxisVector& position) const {
  ChannelArray slope{};
  if (segment.self_motion) return evaluate_self_motion(segment, s, position, slope);
  if (segment.rotary) return evaluate_rotary(segment, s, position, slope);
  return axes(pose_at(segment, s), position);
}

SolveStatus PathKinematics::evaluate(const PathSegment& segment, double s, kinematics::AxisVector& position,
                                     ChannelArray& slope) const {
  slope.fill(0);
  if (segment.self_motion) return evaluate_self_motion(segment, s, position, slope);
  if (segment.rotary) return evaluate_rotary(segment, s, position, slope);
  const Pose X_BT = X_BW_ * pose_at(segment, s);
  SolveStatus status = mechanism_.inverse(X_BT, position, position);
  if (status != SolveStatus::ok || !segment.moves()) return status;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, machine::kMaxAxes, 6> rates(axis_count_, 6);
  status = mechanism_.axis_rates(X_BT, position, rates);
  // A five-axis table is singular wherever its tool stands upright, and prints there all the same; where the
  // way leads out of such a pose, a self-motion comes first.
  if (status != SolveStatus::ok && (mechanism_.follows_spin() || status != SolveStatus::singular))
    return status;
  const Twist twist_W = segment.twist_W();
  Twist twist_B;
  twist_B << X_BW_.linear() * twist_W.head<3>(), X_BW_.linear() * twist_W.tail<3>();
  for (int i = 0; i < axis_count_; ++i) slope[i] = rates.row(i).dot(twist_B);
  slope[axis_count_] = twist_W.head<3>().norm();
  return SolveStatus::ok;
}

SolveStatus PathKinematics::evaluate_rotary(const PathSegment& segment, double s,
                                            kinematics::AxisVector& position, ChannelArray& slope) const {
  kinematics::RotaryTarget rate;
  if (segment.moves()) {
    const auto& [from, to] = *segment.rotary;
    rate = {X_BW_.linear() * segment.tip_slope(), (to.b - from.b) / segment.length,
            (to.c - from.c) / segment.length};
    slope[axis_count_] = segment.tip_slope().norm();
  }
  return mechanism_.axes_at_turns(turned_tip(segment, s), rate, position,
                                  std::span(slope).first(static_cast<std::size_t>(axis_count_)));
}

/// The free axis goes straight from one end to the other; the inverse lets it, and moves the rest with it.
SolveStatus PathKinematics::evaluate_self_motion(const PathSegment& segment, double s,
                                                 kinematics::AxisVector& position,
                                                 ChannelArray& slope) const {
  const Pose X_BT = X_BW_ * segment.X_WT_begin;
  const auto at = [&](double share, kinematics::AxisVector& axes) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i] = (1 - share) * segment.self_motion->from[i] + share * segment.self_motion->to[i];
    return mechanism_.inverse(X_BT, axes, axes);
  };
  constexpr double kStep = 1e-5;  // of the motion: far above rounding, far below what bends
  kinematics::AxisVector before{}, after{};
  const double share = s / segment.length;
  for (const SolveStatus status : {at(share - kStep, before), at(share + kStep, after), at(share, position)})
    if (status != SolveStatus::ok) return status;
  for (int i = 0; i < axis_count_; ++i) slope[i] = (after[i] - before[i]) / (2 * kStep * segment.length);
  return SolveStatus::ok;
}

std::pair<int, double> PathKinematics::largest_turn(const kinematics::AxisVector& from,
                                                    const kinematics::AxisVector& to) const {
  std::pair<int, double> largest{0, 0.0};
  for (int i = 0; i < axis_count_; ++i) {
    const double turn = std::abs(to[i] - from[i]);
    if (mechanism_.axis_is_angle(i) && turn > largest.second) largest = {i, turn};
  }
  return largest;
}

std::optional<PathSegment> PathKinematics::self_motion_before(const PathSegment& segment,
                                                              const kinematics::AxisVector& position) const {
  constexpr double kAhead = 1e-3;    // of a segment: there its way has shown which axes it needs
  constexpr double kSettled = 0.02;  // [rad], what an axis may move up to there without a turn of its own
  if (mechanism_.follows_spin() || segment.rotary || !segment.moves() || segment.turn == 0)
    return std::nullopt;
  kinematics::AxisVector from = position, to = position;
  if (axes(segment.X_WT_begin, from) != SolveStatus::ok ||
      axes_at(segment, kAhead * segment.length, to) != SolveStatus::ok)
    return std::nullopt;
  if (largest_turn(from, to).second <= kSettled) return std::nullopt;
  if (axes(segment.X_WT_begin, to) != SolveStatus::ok) return std::nullopt;
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
                                       kinematics::AxisVector& position) const {
  if (segment.rotary && check == PoseCheck::solvable && !mechanism_.follows_spin()) {  // by slides, all of it
    if (axes_at(segment, segment.length, position) != SolveStatus::ok)
      refuse(segment.line, "the axes are not finite");
    return;
  }
  // An axis turns fast near a singular pose. Condition numbers grow as the way nears it, so that coarse looks
  // tell where finer ones are needed.
  constexpr double kNear = 20;    // condition number of a pose that is well away from it
  constexpr double kFinest = 64;  // 0.02 degrees of the tool
  const kinematics::AxisVector begin = position;
  for (int fineness = 1;;) {
    segment.fineness = fineness;
    position = begin;
    const Walk seen = walk(segment, check, position);
    fineness = static_cast<int>(std::clamp(seen.condition / kNear, 1.0, kFinest));
    if (fineness > segment.fineness) continue;
    if (seen.leap > kMaxAxisJump)
      refuse(segment.line, "axis " + mechanism_.axis_name(seen.leaping_axis) + " would leap by " +
                               std::to_string(to_deg(seen.leap)) +
                               " deg: the way passes too near a singular pose");
    return;
  }
}

PathKinematics::Walk PathKinematics::walk(const PathSegment& segment, PoseCheck check,
                                          kinematics::AxisVector& position) const {
  std::vector<kinematics::LimitViolation> violations;
  const auto require = [&](double s, kinematics::AxisVector& near) {
    const Pose X_WT = pose_at(segment, s);
    const SolveStatus status = axes_at(segment, s, near);
    const std::span<const double> solution = near;
    if (status != SolveStatus::ok || check == PoseCheck::limits)
      mechanism_.check(X_BW_ * X_WT, status == SolveStatus::ok ? solution : std::span<const double>(),
                       violations);
    if (!violations.empty()) refuse(segment.line, to_string(violations.front()));
    if (status != SolveStatus::ok) refuse(segment.line, std::string("the pose is ") + to_string(status));
  };
  const bool named = segment.self_motion || segment.rotary;  // where the axes go; nothing leaps
  const bool may_pass = !mechanism_.follows_spin() && !named && segment.turn > 0;
  const int parts = segment.self_motion
                        ? std::max(1, static_cast<int>(std::ceil(segment.length / kTurnRadius / kCheckTurn)))
                        : segment.fineness * parts_of(segment, kCheckTravel, kCheckTurn);
  kinematics::AxisVector end = position;
  require(segment.length, end);  // the programmed pose before those on the way to it
  Walk seen;
  for (int k = 1; k <= parts; ++k) {
    const kinematics::AxisVector before = position;
    const double s = segment.length * k / parts;
    require(s, position);
    if (may_pass)
      seen.condition =
          std::max(seen.condition, mechanism_.condition_number(X_BW_ * pose_at(segment, s), position));
    if (const auto [axis, turn] = largest_turn(before, position); !segment.rotary && turn > seen.leap) {
      seen.leap = turn;
      seen.leaping_axis = axis;
    }
  }
  return seen;
}

}  // namespace understudy::control

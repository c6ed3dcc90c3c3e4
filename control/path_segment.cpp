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

Solve PathKinematics::evaluate(const PathSegment& segment, const Pose& X_WT, machine::AxisArray& position,
                               ChannelArray& slope) const {
  const Pose X_BT = X_BW_ * X_WT;
  Solve status = mechanism_.inverse(X_BT, position, position);
  slope.fill(0);
  if (status != Solve::ok || !segment.moves()) return status;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, machine::kMaxAxes, 6> rates(axis_count_, 6);
  status = mechanism_.axis_rates(X_BT, position, rates);
  if (status != Solve::ok) return status;
  const Twist twist_W = segment.twist_W();
  Twist twist_B;
  twist_B << X_BW_.linear() * twist_W.head<3>(), X_BW_.linear() * twist_W.tail<3>();
  for (int i = 0; i < axis_count_; ++i) slope[static_cast<std::size_t>(i)] = rates.row(i).dot(twist_B);
  slope[static_cast<std::size_t>(axis_count_)] = twist_W.head<3>().norm();
  return status;
}

void PathKinematics::require_reachable(const PathSegment& segment, PoseCheck check,
                                       machine::AxisArray near) const {
  std::vector<kinematics::LimitViolation> violations;
  const auto require = [&](const Pose& X_WT) {
    const Solve status = axes(X_WT, near);
    if (status != Solve::ok || check == PoseCheck::limits) mechanism_.check(X_BW_ * X_WT, violations);
    if (!violations.empty()) refuse(segment.line, to_string(violations.front()));
    if (status != Solve::ok) refuse(segment.line, std::string("the pose is ") + to_string(status));
  };
  require(segment.X_WT_end);  // the programmed pose before those on the way to it
  const int parts = parts_of(segment, kCheckTravel, kCheckTurn);
  for (int k = 1; k < parts; ++k) require(segment.pose_at(segment.length * k / parts));
}

}  // namespace understudy::control

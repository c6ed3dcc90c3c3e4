#include "control/motion/path_segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {

using toolpath::StepKind;

namespace {

constexpr double kRigidTolerance = 1e-6;  // of R^T R - I

void require_pose(const toolpath::Step& step) {
  if (!step.X_WT.matrix().allFinite()) refuse(step.line, "the pose is not finite");
  const Mat3 R = step.X_WT.linear();
  if ((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() > kRigidTolerance || R.determinant() < 0)
    refuse(step.line, "the orientation is not a rotation");
}

void require_figures(const toolpath::Step& step) {
  if (!std::isfinite(step.duration) || step.duration < 0)
    refuse(step.line, "duration is " + std::to_string(step.duration) + " s, must be 0 or more");
  if (!(step.acceleration > 0))
    refuse(step.line, "acceleration is " + std::to_string(step.acceleration) + " m/s^2, must be above 0");
  if (!std::isfinite(step.filament)) refuse(step.line, "the filament's length is not finite");
}

double linear_speed(const toolpath::Step& step, const MotionLimits& limits) {
  if (step.kind == StepKind::travel || step.kind == StepKind::home) return limits.travel_velocity;
  if (!(step.feed > 0) || !std::isfinite(step.feed))
    refuse(step.line, "feed is " + std::to_string(to_mm(step.feed)) + " mm/s, must be above 0");
  return step.feed;
}

// Speed of s: the programmed speed of the tip, or the inverse time of G93, within the angular speed of a tool
// that turns by `turn` [rad].
double path_speed(const toolpath::Step& step, const PathSegment& segment, double turn,
                  const MotionLimits& limits) {
  double speed = std::numeric_limits<double>::infinity();
  const double travel = segment.travel.norm();
  if (step.duration > 0)
    speed = segment.length / step.duration;
  else if (const double tip_speed = linear_speed(step, limits); travel > 0)
    speed = tip_speed * (segment.length / travel);
  if (turn > 0) speed = std::min(speed, limits.orientation_velocity * (segment.length / turn));
  return speed;
}

// Of the tool's axis, at the most, while B and C run: its spin is none of the work's.
double leaning_turn(const PathSegment::Rotary& rotary) {
  const auto& [from, to] = rotary;
  const double reach = std::min(std::max(std::abs(from.b), std::abs(to.b)), std::numbers::pi / 2);
  return std::hypot(to.b - from.b, std::sin(reach) * (to.c - from.c));
}

}  // namespace

void refuse(int line, const std::string& message) {
  throw InputError(Place{"", line, 0}, "line " + std::to_string(line) + ": " + message);
}

PathSegment make_segment(const toolpath::Step& step, const Pose& X_WT_begin,
                         const std::optional<PathSegment::Rotary>& rotary, const MotionLimits& limits) {
  require_figures(step);
  if (toolpath::moves(step)) require_pose(step);
  PathSegment segment;
  segment.line = step.line;
  segment.X_WT_begin = segment.X_WT_end = X_WT_begin;
  segment.filament_end = step.filament;
  segment.acceleration = step.acceleration;
  segment.rotary = rotary;
  if (toolpath::moves(step)) {
    segment.travel = step.X_WT.translation() - X_WT_begin.translation();
    double leaning = 0;
    if (rotary) {
      segment.turn = std::hypot(rotary->to.b - rotary->from.b, rotary->to.c - rotary->from.c);
      leaning = leaning_turn(*rotary);
    } else {
      const Vec3 turn = log_rotation(X_WT_begin.linear().transpose() * step.X_WT.linear());
      segment.turn = leaning = turn.norm();
      if (segment.turn > 0) segment.turn_axis = turn / segment.turn;
    }
    segment.length = std::max(segment.travel.norm(), kTurnRadius * segment.turn);
    if (segment.length > kShortestPath) {
      segment.X_WT_end = step.X_WT;
      segment.speed = path_speed(step, segment, leaning, limits);
      return segment;
    }
    segment.travel.setZero();
    segment.length = segment.turn = 0;
  }
  if (segment.rotary) segment.rotary->to = segment.rotary->from;
  segment.rest = step.duration;
  if (step.duration == 0 && step.filament != 0)
    segment.rest = std::abs(step.filament) / linear_speed(step, limits);
  return segment;
}

toolpath::RotaryTurns PathSegment::turns_at(double s) const {
  const auto& [from, to] = *rotary;
  if (s >= length) return to;
  const double t = s / length;
  return {from.b + t * (to.b - from.b), from.c + t * (to.c - from.c)};
}

Vec3 PathSegment::tip_at(double s) const {
  if (s >= length) return X_WT_end.translation();
  return X_WT_begin.translation() + (s / length) * travel;
}

Twist PathSegment::twist_W() const {
  Twist twist;
  twist << tip_slope(), X_WT_begin.linear() * turn_axis * (turn / length);
  return twist;
}

double PathSegment::filament_at(double fraction) const {
  if (fraction >= 1) return filament_end;
  return filament_begin + fraction * (filament_end - filament_begin);
}

int parts_of(const PathSegment& segment, double travel, double turn) {
  const double parts = std::max(segment.length / travel, segment.turn / turn);
  return std::max(1, static_cast<int>(std::ceil(parts - 1e-9)));
}

}  // namespace understudy::control

#include "control/motion/motion_planner.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "control/motion/path_grid.h"
#include "core/assert.h"
#include "core/error.h"

namespace understudy::control {

using kinematics::AxisVector;
using kinematics::SolveStatus;

namespace {

constexpr std::size_t kWindowPieces = 8192;  // some 4 MB

void require_positive(const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(std::string(what) + " is " + std::to_string(value) + ", must be above 0");
}

ChannelLimits channel_limits(const MotionLimits& limits, int axis_count) {
  ChannelLimits channels;
  channels.count = axis_count + 1;
  std::copy_n(limits.axis_acceleration.begin(), axis_count, channels.acceleration.begin());
  std::copy_n(limits.velocity_jump.begin(), axis_count, channels.velocity_jump.begin());
  const int tip = axis_count;
  channels.acceleration[tip] = limits.tip_acceleration;
  if (std::isinf(corner_velocity_change(limits)))
    channels.velocity_jump[tip] = std::numeric_limits<double>::infinity();
  channels.cycle_time = limits.cycle_time;
  channels.corner_share = limits.planner.corner_share;
  return channels;
}

}  // namespace

// Steps become segments; a segment is cut into pieces when its end is known (the next one has come, or
// finish); pieces are planned in windows and handed out as points. Times here count from `start_time`.
struct MotionPlanner::State {
  State(const kinematics::Mechanism& mechanism, const Pose& X_WB, const MotionLimits& motion_limits,
        const MotionStart& start, PoseCheck pose_check);

  PathKinematics kinematics;
  PlannerLimits limits;
  PoseCheck check;

  std::deque<PathSegment> segments;
  std::size_t first_segment = 0;  // running number of segments.front()
  std::size_t cut_segments = 0;   // running number of the first that is not cut yet
  std::size_t steps_pushed = 0;
  Pose X_WT_rest;  // at the end of what was queued
  double filament_rest = 0;
  AxisVector axes_rest{};  // at the end of what was cut
  AxisVector axes_end{};   // at the end of what was queued

  std::deque<Piece> pieces;
  double window_length = 0;   // [m]
  std::size_t settled = 0;    // pieces up to a stop that finish() asked for
  std::size_t committed = 0;  // pieces whose speed is final
  double speed2 = 0;          // where pieces.front() begins

  double start_time = 0;
  std::int64_t cycle = 0;  // last one handed out
  double piece_time = 0;   // when pieces.front() begins
  AxisVector axes_now{};
  bool resting = true;  // the last point handed out is at rest at the end of everything

  void push(const toolpath::Step& step);
  void find_slopes(PathSegment& segment, AxisVector& axes) const;
  void queue(PathSegment segment);
  double junction_speed(const PathSegment& before, const PathSegment& after) const;
  void cut_last(double exit_speed);
  void finish();
  bool plan();
  void pass_front();
  void point_on_front(double elapsed, PlannedPoint& point);
  bool next(PlannedPoint& point);
};

MotionPlanner::State::State(const kinematics::Mechanism& mechanism, const Pose& X_WB,
                            const MotionLimits& motion_limits, const MotionStart& start, PoseCheck pose_check)
    : kinematics(mechanism, X_WB),
      limits{motion_limits, channel_limits(motion_limits, mechanism.axis_count())},
      check(pose_check),
      X_WT_rest(start.X_WT),
      start_time(start.time) {
  require_positive("cycle time", limits.motion.cycle_time);
  require_positive("tip acceleration", limits.motion.tip_acceleration);
  require_positive("travel velocity", limits.motion.travel_velocity);
  require_positive("orientation velocity", limits.motion.orientation_velocity);
  for (int i = 0; i < kinematics.axis_count(); ++i) {
    require_positive("axis velocity", limits.motion.axis_velocity[i]);
    require_positive("axis acceleration", limits.motion.axis_acceleration[i]);
    if (!(limits.motion.velocity_jump[i] >= 0) || !std::isfinite(limits.motion.velocity_jump[i]))
      throw InputError("velocity jump is " + std::to_string(limits.motion.velocity_jump[i]) +
                       ", must be 0 or more");
  }
  SolveStatus status = SolveStatus::ok;
  if (start.axes)
    axes_rest = *start.axes;
  else
    status = mechanism.inverse(X_WB.inverse() * start.X_WT, {}, axes_rest);
  if (status == SolveStatus::ok) status = kinematics.axes(start.X_WT, axes_rest);
  if (status != SolveStatus::ok)
    throw InputError(std::string("the pose to start from is ") + to_string(status));
  axes_now = axes_end = axes_rest;
}

void MotionPlanner::State::push(const toolpath::Step& step) {
  if (!toolpath::moves(step) && step.kind != toolpath::StepKind::dwell) {
    ++steps_pushed;
    return;
  }
  PathSegment segment = kinematics.segment(step, X_WT_rest, axes_end, limits.motion);
  segment.step = steps_pushed;
  AxisVector axes = axes_end;
  std::optional<PathSegment> first = kinematics.self_motion_before(segment, axes);
  if (first) find_slopes(*first, axes);
  if (segment.moves()) find_slopes(segment, axes);
  ++steps_pushed;
  if (first) queue(std::move(*first));
  queue(std::move(segment));
  axes_end = axes;
}

// Leaves the planner as it is when the segment cannot be.
void MotionPlanner::State::find_slopes(PathSegment& segment, AxisVector& axes) const {
  AxisVector near = axes;
  kinematics.require_reachable(segment, check, axes);
  SolveStatus status = kinematics.evaluate(segment, 0, near, segment.slope_begin);
  near = axes;
  if (status == SolveStatus::ok)
    status = kinematics.evaluate(segment, segment.length, near, segment.slope_end);
  if (status != SolveStatus::ok)
    throw InputError(Place{"", segment.line, 0},
                     "line " + std::to_string(segment.line) + ": the pose is " + to_string(status));
}

void MotionPlanner::State::queue(PathSegment segment) {
  segment.filament_begin = filament_rest;
  segment.filament_end += filament_rest;
  filament_rest = segment.filament_end;
  if (!segment.moves() && segment.rest == 0) return;
  if (cut_segments < first_segment + segments.size()) {
    segment.entry_speed = junction_speed(segments.back(), segment);
    cut_last(segment.entry_speed);
  }
  X_WT_rest = segment.X_WT_end;
  segments.push_back(segment);
  resting = false;
}

// Where one of the two is a rest, what the axes can do at once. A shorter one could have the jump of the stop
// and that of the start in one cycle.
double MotionPlanner::State::junction_speed(const PathSegment& before, const PathSegment& after) const {
  const int axes = kinematics.axis_count();
  double speed = std::numeric_limits<double>::infinity();
  if (before.moves()) speed = speed_limit(before.speed, before.slope_end, limits.motion, axes);
  if (after.moves())
    speed = std::min(speed, speed_limit(after.speed, after.slope_begin, limits.motion, axes));
  if (before.moves() && after.moves())
    return std::min(speed, corner_speed(corner_jump(before, after, axes), limits.channels));
  const double rest = std::max(before.rest, after.rest);
  if (before.moves() == after.moves() || rest < limits.motion.cycle_time) return 0;
  return std::min(speed, jump_speed(corner_jump(before, after, axes), limits.channels));
}

// Cuts the one segment that waits for its end to be known.
void MotionPlanner::State::cut_last(double exit_speed) {
  const std::size_t index = cut_segments - first_segment;
  const PathSegment& segment = segments[index];
  SegmentPlace place{cut_segments, exit_speed, {}};
  if (segment.entry_speed > 0)
    place.jump = corner_jump(segments[index - 1], segment, kinematics.axis_count());
  append_pieces(segment, place, kinematics, limits, axes_rest, pieces);
  window_length += segment.length;
  ++cut_segments;
}

void MotionPlanner::State::finish() {
  if (cut_segments < first_segment + segments.size()) cut_last(0);
  settled = pieces.size();
}

// Plans everything that is cut. Final is what a stop at the window's end cannot reach back to: its first
// half.
bool MotionPlanner::State::plan() {
  const bool full = pieces.size() >= kWindowPieces || window_length >= limits.motion.planner.lookahead;
  if (settled == 0 && !full) return false;
  limit_corners(pieces, limits.channels);
  plan_speeds(pieces, speed2, limits.channels);
  committed = settled;
  if (full) {
    std::size_t half = 0;
    double length = 0;
    while (half < pieces.size() / 2 && length < window_length / 2) length += pieces[half++].length;
    committed = std::max(settled, half);
  }
  return committed > 0;
}

void MotionPlanner::State::pass_front() {
  const Piece& piece = pieces.front();
  piece_time += piece.duration();
  speed2 = piece.end_speed2;
  window_length -= piece.length;
  if (settled > 0) --settled;
  --committed;
  const std::size_t number = piece.segment;
  pieces.pop_front();
  if (!pieces.empty() && pieces.front().segment == number) return;
  // The segment before stays: the corner to the next one is made from it.
  while (first_segment < number) {
    segments.pop_front();
    ++first_segment;
  }
}

void MotionPlanner::State::point_on_front(double elapsed, PlannedPoint& point) {
  const Piece& piece = pieces.front();
  const PathSegment& segment = segments[piece.segment - first_segment];
  double s = 0, speed = 0;
  if (piece.length > 0) {
    const double begin_speed = std::sqrt(piece.node_speed2);
    const double u = (piece.end_speed2 - piece.node_speed2) / (2 * piece.length);
    s = piece.begin + std::min(piece.length, elapsed * (begin_speed + 0.5 * u * elapsed));
    speed = std::max(0.0, begin_speed + u * elapsed);
  }
  point.fraction = segment.self_motion ? 0
                   : segment.moves()   ? std::min(1.0, s / segment.length)
                                       : std::min(1.0, elapsed / segment.rest);
  point.X_WT = kinematics.pose_at(segment, s);
  point.step = segment.step;
  point.setpoint.line = segment.line;
  point.setpoint.filament = segment.filament_at(point.fraction);
  ChannelArray slope{};
  const auto solved = kinematics.evaluate(segment, s, axes_now, slope);
  UNDERSTUDY_ASSERT(solved == kinematics::SolveStatus::ok || solved == kinematics::SolveStatus::singular,
                    "push() has looked along the whole segment");
  point.setpoint.position = axes_now;
  for (int i = 0; i < kinematics.axis_count(); ++i) point.setpoint.velocity[i] = slope[i] * speed;
}

bool MotionPlanner::State::next(PlannedPoint& point) {
  if (resting) return false;
  const double time = static_cast<double>(cycle + 1) * limits.motion.cycle_time;
  while (!pieces.empty()) {
    if (committed == 0 && !plan()) return false;
    const double end = piece_time + pieces.front().duration();
    if (time <= end) break;
    pass_front();
  }
  point = PlannedPoint{};
  if (pieces.empty()) {
    if (cut_segments < first_segment + segments.size()) return false;
    const PathSegment& segment = segments.back();
    point.X_WT = segment.X_WT_end;
    point.step = segment.step;
    point.fraction = 1;
    point.setpoint.line = segment.line;
    point.setpoint.filament = filament_rest;
    const auto solved = kinematics.axes_at(segment, segment.length, axes_now);
    UNDERSTUDY_ASSERT(solved == kinematics::SolveStatus::ok || solved == kinematics::SolveStatus::singular,
                      "push() has looked at the segment's end");
    point.setpoint.position = axes_now;
    piece_time = time;
    resting = true;
  } else {
    point_on_front(time - piece_time, point);
  }
  ++cycle;
  point.setpoint.time = start_time + time;
  return true;
}

MotionPlanner::MotionPlanner(const kinematics::Mechanism& mechanism, const Pose& X_WB,
                             const MotionLimits& limits, const MotionStart& start, PoseCheck check)
    : state_(std::make_unique<State>(mechanism, X_WB, limits, start, check)) {}
MotionPlanner::~MotionPlanner() = default;

void MotionPlanner::push(const toolpath::Step& step) { state_->push(step); }
void MotionPlanner::finish() { state_->finish(); }
bool MotionPlanner::next(PlannedPoint& point) { return state_->next(point); }
double MotionPlanner::time() const {
  return state_->start_time + static_cast<double>(state_->cycle) * state_->limits.motion.cycle_time;
}
Pose MotionPlanner::resting_pose() const { return state_->X_WT_rest; }
kinematics::AxisVector MotionPlanner::resting_axes() const { return state_->axes_end; }

}  // namespace understudy::control

// Lookahead motion planner: poses and feeds in, setpoints at the port's cycle out.
//
// The tip runs on straight lines over the work, with the orientation on the shortest arc between programmed
// poses, or, where the program names the turning axes, with these running linearly (toolpath::Step). Speed
// along the path obeys the programmed feed, the tip's acceleration, the tool's angular speed and, through
// the mechanism's Jacobian, the velocity and acceleration limit of every axis, also across the junctions of
// the polyline. Nothing else shapes it: no corner is rounded, every programmed pose is reached exactly.
#pragma once

#include <memory>
#include <optional>

#include "control/motion/motion_limits.h"
#include "control/motion/planned_point.h"
#include "toolpath/program.h"

namespace understudy::control {

/// The rest that a motion starts from.
struct MotionStart {
  Pose X_WT = Pose::Identity();
  double time = 0;  ///< [s]
  /// Pick the branch; without, home does.
  std::optional<kinematics::AxisVector> axes = std::nullopt;
};

/// Streams a program: call next() until it is false after each push(), and memory is bounded by the lookahead
/// window (`planner.lookahead` of path or some thousand pieces, whichever is shorter), not by the program.
/// The plan can always stop at the window's end.
///
/// Feeds (G94) are speeds of the tip; where the tool turns by more than a radian in 5 mm of tip travel, the
/// turn is what is timed, at most at `orientation_velocity` (of the tool's axis, where B and C are named:
/// what spins the tool is limited by its drive alone). G93: the step's path at constant speed takes
/// `duration`; speeding up and slowing down come on top. G0 and G28 run at `travel_velocity`. A step that
/// feeds filament without moving takes |filament| / feed. Steps that neither move nor dwell are ignored.
/// Acceleration is switched, not ramped: jerk is not limited. At a corner the velocity of each axis changes
/// within one cycle by at most half of acceleration * cycle_time and `velocity_jump`; the other half is for
/// speeding up and down. So within any cycle an axis changes its velocity by at most acceleration *
/// cycle_time
/// + velocity_jump, however dense the corners. Stops for a rest of a cycle or more, and the starts after it,
/// take the jump alone; others none. The tip's own acceleration does not hold at corners where there are such
/// jumps. Where a step leaves a pose that lets an axis turn freely (a table under an upright tool), the axis
/// turns to where the step needs it first, with the tool at rest on the part.
class MotionPlanner {
 public:
  /// The mechanism and X_WB must outlive the planner. Throws InputError for a start that the mechanism cannot
  /// reach, and for limits that are not positive.
  MotionPlanner(const kinematics::Mechanism& mechanism, const Pose& X_WB, const MotionLimits& limits,
                const MotionStart& start, PoseCheck check = PoseCheck::limits);
  ~MotionPlanner();

  /// Queues a step that moves or dwells. Throws InputError naming the line and the axis or strut and by how
  /// much, when a pose on the way cannot be reached; the planner is then as before the call.
  void push(const toolpath::Step& step);
  /// No more steps for now: what is queued ends at rest.
  void finish();
  /// The next cycle: times are those of the start + n cycle_time, n = 1, 2, ...; the last one of a stretch is
  /// at rest, at most one cycle after the motion's end. False: push more, or (after finish) everything was
  /// handed out and the tool rests.
  bool next(PlannedPoint& point);

  double time() const;        ///< [s] of the last point handed out
  Pose resting_pose() const;  ///< X_WT at the end of what was queued
  kinematics::AxisVector resting_axes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::control

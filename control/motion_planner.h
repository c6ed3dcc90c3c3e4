// Lookahead motion planner: poses and feeds in, setpoints at the port's cycle out.
//
// The tip runs on straight lines with the orientation on the shortest arc between programmed poses. Speed
// along the path obeys the programmed feed, the tip's acceleration, the tool's angular speed and, through
// the mechanism's Jacobian, the velocity and acceleration limit of every axis, also across the junctions of
// the polyline. Nothing else shapes it: no corner is rounded, every programmed pose is reached exactly.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/mechanism.h"
#include "machine/description.h"
#include "machine/port.h"
#include "toolpath/program.h"

namespace understudy::control {

struct MotionLimits {
  machine::AxisArray axis_velocity{};        ///< [m/s or rad/s]
  machine::AxisArray axis_acceleration{};    ///< [m/s^2 or rad/s^2]
  double tip_acceleration = 0;               ///< [m/s^2]
  double travel_velocity = 0;                ///< [m/s], G0
  double orientation_velocity = 0;           ///< [rad/s]
  double cycle_time = 0;                     ///< [s]
};
MotionLimits motion_limits(const machine::MachineDescription& machine);

/// One planned cycle. `X_WT` is the commanded pose that the axes were computed from.
struct PlannedPoint {
  machine::Setpoint setpoint;
  Pose X_WT = Pose::Identity();
};

/// Streams a program: memory is bounded by the lookahead window, not by the program.
class MotionPlanner {
 public:
  /// The mechanism and X_WB must outlive the planner. Starts at rest at X_WT_start at `start_time`.
  MotionPlanner(const kinematics::Mechanism& mechanism, const Pose& X_WB, const MotionLimits& limits,
                const Pose& X_WT_start, double start_time);
  ~MotionPlanner();

  /// Queues a step that moves or dwells. Throws InputError naming the line and the axis or strut and by how
  /// much, when a pose on the way cannot be reached.
  void push(const toolpath::Step& step);
  /// No more steps for now: what is queued ends at rest.
  void finish();
  /// The next cycle. False: push more, or (after finish) everything was handed out and the tool rests.
  bool next(PlannedPoint& point);

  double time() const;          ///< [s] of the last point handed out
  Pose resting_pose() const;    ///< X_WT at the end of what was queued

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::control

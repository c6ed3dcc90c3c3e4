// Hands planned motion to a port: batches, a full queue, deadlines, coming to rest.
#pragma once

#include <memory>
#include <vector>

#include "control/gap/gap_controller.h"
#include "control/motion/motion_planner.h"
#include "machine/description.h"

namespace understudy::control {

/// Stands between planner and port: uses the time while the queue is full enough, and may shift what is still
/// to be queued.
class SetpointFilter {
 public:
  virtual ~SetpointFilter() = default;
  virtual double lead() const = 0;  ///< [s] of motion that the queue holds: what is queued stays as it is
  /// Lets the port's clock run to about `until`, and never to the queue's end.
  virtual machine::Status pass_time(double until) = 0;
  /// Takes a point and hands out the one before, shifted. False: there is none yet.
  virtual bool shift(const PlannedPoint& point, machine::Setpoint& ready) = 0;
  virtual bool flush(machine::Setpoint& ready) = 0;  ///< the last one of a stretch
  virtual GapStop stop() const = 0;                  ///< none: go on
};

/// Owns the planner of the current stretch of motion; between stretches the tool rests at `resting_pose()`.
class SetpointStreamer {
 public:
  /// With a `watch` the planner leaves a small share of the axes' limits to it.
  SetpointStreamer(const machine::MachineDescription& machine, machine::MachinePort& port,
                   const Pose& X_WT_start, SetpointFilter* watch = nullptr);

  /// Plans and queues as far as the lookahead allows. InputError from the planner passes through and leaves
  /// the motion as before the call.
  machine::Status push(const toolpath::Step& step);
  /// Ends the stretch: everything queued is executed and the tool rests.
  machine::Status come_to_rest();
  /// Brakes, drops what is queued, waits until the tool rests and goes on from there. `filament` was fed by
  /// then [m].
  machine::Status abandon(double filament);
  /// At rest: the tool stands off the pushed pose by this, as the watch has shifted it.
  void shift_rest(const Vec3& offset_W) { X_WT_rest_.translation() += offset_W; }

  machine::MachinePort& port() { return port_; }
  Pose resting_pose() const;  ///< X_WT at the end of what was pushed

 private:
  machine::Status pump();
  machine::Status queue_watched(const PlannedPoint& point);
  machine::Status queue_braking_way();
  machine::Status hand_over();
  /// wait_until in slices, so that an interrupt (thrown as Interrupted) is not slept through.
  machine::Status wait_until(double time);

  const machine::MachineDescription& machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  MotionLimits limits_;
  machine::MachinePort& port_;
  SetpointFilter* watch_;
  std::unique_ptr<MotionPlanner> planner_;
  std::vector<machine::Setpoint> batch_;
  std::size_t batch_size_;
  Pose X_WT_rest_;
  kinematics::AxisVector axes_rest_;  ///< there
  double filament_ = 0;               ///< [m], fed by everything pushed
  double filament_at_start_ = 0;      ///< [m], when the stretch began: planners count from 0
  double end_time_ = 0;               ///< [s], of the last setpoint queued
  std::uint64_t dropped_ = 0;         ///< setpoints that were queued and then abandoned
};

}  // namespace understudy::control

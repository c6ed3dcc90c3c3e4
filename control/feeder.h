// Hands planned motion to a port: batches, a full queue, deadlines, coming to rest.
#pragma once

#include <memory>
#include <vector>

#include "control/motion_planner.h"
#include "machine/description.h"

namespace understudy::control {

/// Owns the planner of the current stretch of motion; between stretches the tool rests at `resting_pose()`.
class Feeder {
 public:
  Feeder(const machine::MachineDescription& machine, machine::MachinePort& port, const Pose& X_WT_start);

  /// Plans and queues as far as the lookahead allows. InputError from the planner passes through and leaves
  /// the motion as before the call.
  machine::Status push(const toolpath::Step& step);
  /// Ends the stretch: everything queued is executed and the tool rests.
  machine::Status come_to_rest();

  machine::MachinePort& port() { return port_; }
  Pose resting_pose() const;  ///< X_WT at the end of what was pushed

 private:
  machine::Status pump();
  machine::Status hand_over();
  /// wait_until in slices, so that an interrupt (thrown as Interrupted) is not slept through.
  machine::Status wait_until(double time);

  const machine::MachineDescription& machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  MotionLimits limits_;
  machine::MachinePort& port_;
  std::unique_ptr<MotionPlanner> planner_;
  std::vector<machine::Setpoint> batch_;
  std::size_t batch_size_;
  Pose X_WT_rest_;
  machine::AxisArray axes_rest_;  ///< there
  double filament_ = 0;           ///< [m], fed by everything pushed
  double filament_at_start_ = 0;  ///< [m], when the stretch began: planners count from 0
  double end_time_ = 0;           ///< [s], of the last setpoint queued
};

}  // namespace understudy::control

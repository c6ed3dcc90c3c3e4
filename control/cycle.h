// The control cycle: read -> update -> write, once for every stretch of motion that is due.
#pragma once

#include <memory>

#include "control/gap/continuous_gap_controller.h"
#include "control/motion/motion_planner.h"
#include "control/setpoint_streamer.h"

namespace understudy::control {

struct CycleOptions {
  /// Outlives the cycle; the planner leaves a small share of the axes' limits to it.
  ContinuousGapController* gap = nullptr;
  PoseCheck poses = PoseCheck::limits;  ///< what a pose must satisfy
};

/// Owns the planner of the current stretch of motion; between stretches the tool rests at `resting_pose()`.
class ControlCycle {
 public:
  ControlCycle(const machine::MachineDescription& machine, machine::MachinePort& port, const Pose& X_WT_start,
               const CycleOptions& options = {});

  /// Plans and queues as far as the lookahead allows. InputError from the planner passes through and leaves
  /// the motion as before the call.
  Stop push(const toolpath::Step& step);
  /// Ends the stretch: everything queued is executed and the tool rests.
  Stop come_to_rest();
  /// Brakes, drops what is queued, waits until the tool rests and goes on from there. `filament` was fed by
  /// then [m].
  Stop abandon(double filament);
  /// At rest: the tool stands off the pushed pose by this, as the gap controller has shifted it.
  void shift_rest(const Vec3& offset_W) { X_WT_rest_.translation() += offset_W; }

  machine::MachinePort& port() { return streamer_.port(); }
  Pose resting_pose() const;  ///< X_WT at the end of what was pushed
  /// G-code line that the machine is at, behind what was pushed; 0 before the first.
  int line_executed() const { return streamer_.line_executed(); }

 private:
  Stop run();
  Stop read();
  Stop update();
  Stop write();

  bool next_point();
  bool due() const;
  void take_point();
  Stop gap_stop() const;
  Stop queue_braking_path();

  const machine::MachineDescription& machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  const MotionLimits limits_;
  SetpointStreamer streamer_;
  ContinuousGapController* gap_;
  PoseCheck poses_;
  std::unique_ptr<MotionPlanner> planner_;
  PlannedPoint point_;  ///< the next one, when `pending_`
  bool pending_ = false;
  bool clock_stands_ = false;  ///< the port's clock comes no nearer to when that point is due
  Pose X_WT_rest_;
  kinematics::AxisVector axes_rest_;  ///< there
  double filament_ = 0;               ///< [m], fed by everything pushed
  double filament_at_start_ = 0;      ///< [m], when the stretch began: planners count from 0
};

}  // namespace understudy::control

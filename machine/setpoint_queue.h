// Setpoints between a controller and the drives: what is accepted, when it counts as executed, and where the
// axes shall be in between. One queue lies under every port, so that a controller meets the same rules on the
// twin, in tests and on the machine (docs/machine-port.md). Memory is fixed once made: no call allocates.
//
// The queue has a clock of its own. It runs with the port's, stands still while the queue is held, and slows
// down and speeds up linearly on the way: axes brake along the path that is queued.
#pragma once

#include <vector>

#include "machine/port.h"

namespace understudy::machine {

struct SetpointQueueOptions {
  std::size_t capacity = 4096;                ///< setpoints
  std::vector<kinematics::AxisRange> ranges;  ///< one an axis: how many there are, and what they may take
  AxisVector rest_velocity{};                 ///< [m/s or rad/s], an axis that is no faster counts as resting
};

class SetpointQueue {
 public:
  /// What the drives are to do at a time of the port's clock.
  struct Target {
    AxisVector position{};  ///< [m or rad]
    AxisVector velocity{};  ///< [m/s or rad/s]
    double filament = 0;    ///< [m]
    int line = 0;
  };

  /// The axes rest at `start`.
  SetpointQueue(const SetpointQueueOptions& options, const AxisVector& start, double now);

  /// All or nothing. queue_full: there is no room now. rejected: a time, position, velocity or filament that
  /// is not finite, a time that is not after the one before (of an empty queue: after now), a position out of
  /// its axis' range, or more setpoints than the queue could ever hold.
  Status submit(std::span<const Setpoint> setpoints, double now);

  /// Takes the next setpoint whose time has come off the queue; nullptr: there is none. Valid until the next
  /// call.
  const Setpoint* execute_next(double now);
  /// Executes all of these and interpolates: cubic Hermite between setpoints, filament linear.
  const Target& advance_to(double now);
  const Target& target() const { return target_; }  ///< as advance_to() last found it
  /// The port's clock has come from `now - dt` to `now`: brakes, or speeds up again, and keeps the lag.
  void pass(double dt, double now);

  void hold();             ///< brakes within kBrakingTime and keeps what is queued
  void resume();           ///< speeds up as slowly; of no effect on a stop
  void stop(double now);   ///< brakes as hold() does, then drops what is queued; ends a hold
  void clear(double now);  ///< drops what is queued; the axes rest at the target, at once: a fault

  /// Empty, and the last setpoint was not at rest: an underrun.
  bool ran_dry() const;
  bool moving() const { return size_ > 0 && rate_ > 0; }
  bool rate_changes() const { return slope_ != 0; }  ///< brakes or speeds up
  double lag() const { return lag_; }                ///< [s], the port's clock less the queue's
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t executed() const { return executed_; }  ///< those that were dropped never are
  std::size_t free_slots() const { return ring_.size() - size_; }

 private:
  const Setpoint& back() const { return ring_[(head_ + size_ - 1) % ring_.size()]; }
  bool acceptable(const Setpoint& s) const;

  std::vector<kinematics::AxisRange> ranges_;
  AxisVector rest_velocity_;
  std::vector<Setpoint> ring_;  ///< fixed storage
  std::size_t head_ = 0, size_ = 0;
  Setpoint last_;  ///< executed last; where the axes rest when the queue is empty
  Target target_;
  double lag_ = 0;    ///< [s]; grows while held, and ends with what was queued then
  double rate_ = 1;   ///< of the queue's clock: 1 running, 0 held
  double slope_ = 0;  ///< [1/s], of the rate
  bool stopping_ = false;
  std::uint64_t accepted_ = 0, executed_ = 0;
};

}  // namespace understudy::machine

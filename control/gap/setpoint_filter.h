// Stands between planner and port: shifts planned setpoints along the tool axis.
#pragma once

#include <memory>
#include <vector>

#include "control/motion/planned_point.h"
#include "machine/description.h"

namespace understudy::control {

/// A setpoint is complete when the shift of the one after it is known: the shift's own velocity is its
/// central difference. So setpoints leave one cycle later than they come. Does not allocate while the shifted
/// poses keep the machine's limits.
class SetpointFilter {
 public:
  explicit SetpointFilter(const machine::MachineDescription& machine);

  /// Shifts begin at 0 again; what is held stays.
  void restart() { shift_before_ = shift_held_ = {}; }
  /// Forgets the setpoint that is held, and its shift.
  void drop();

  /// Takes a point, to be shifted by `correction` [m], and hands out the one before. False: there is none.
  bool shift(const PlannedPoint& point, double correction, machine::Setpoint& ready);
  /// The last one of a stretch: it is at rest, and its shift with it. False: there is none.
  bool flush(machine::Setpoint& ready);

  /// False: the axes cannot follow the last correction, and the shift before it holds.
  bool reachable() const { return reachable_; }
  /// The limits that the last correction breaks; none where no axes reach it at all.
  const std::vector<kinematics::LimitViolation>& violations() const { return violations_; }

 private:
  bool axes_shift(const PlannedPoint& point, double correction, kinematics::AxisVector& shift);

  const machine::MachineDescription& machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  machine::Setpoint held_;
  bool holding_ = false;
  kinematics::AxisVector shift_before_{},
      shift_held_{};        // of the setpoint that left last, and of the one held
  double time_before_ = 0;  // [s], of the setpoint that left last
  bool reachable_ = true;
  std::vector<kinematics::LimitViolation> violations_;
};

}  // namespace understudy::control

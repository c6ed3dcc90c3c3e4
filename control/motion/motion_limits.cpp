#include "control/motion/motion_limits.h"

#include <algorithm>
#include <limits>

namespace understudy::control {

MotionLimits motion_limits(const machine::MachineDescription& machine) {
  MotionLimits limits;
  for (std::size_t i = 0; i < limits.axis_velocity.size(); ++i) {
    limits.axis_velocity[i] = machine.drives[i].velocity_max;
    limits.axis_acceleration[i] = machine.drives[i].acceleration_max;
    limits.velocity_jump[i] = machine.drives[i].velocity_jump;
  }
  limits.tip_acceleration = machine.acceleration;
  limits.travel_velocity = machine.travel_velocity;
  limits.orientation_velocity = machine.orientation_velocity;
  limits.cycle_time = machine.cycle_time;
  limits.planner = machine.control.planner;
  return limits;
}

double corner_velocity_change(const MotionLimits& limits) {
  // What turns the tip's way at once is the axes: where they may, it may.
  if (std::ranges::any_of(limits.velocity_jump, [](double v) { return v > 0; }))
    return std::numeric_limits<double>::infinity();
  return limits.planner.corner_share * limits.tip_acceleration * limits.cycle_time;
}

}  // namespace understudy::control

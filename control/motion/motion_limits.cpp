#include "control/motion/motion_limits.h"

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

}  // namespace understudy::control

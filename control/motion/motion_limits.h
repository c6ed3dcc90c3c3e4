// What bounds a motion: speeds and accelerations of the axes and the tip, and what a pose must satisfy.
#pragma once

#include "machine/description.h"
#include "machine/port.h"

namespace understudy::control {

struct MotionLimits {
  kinematics::AxisVector axis_velocity{};      ///< [m/s or rad/s]
  kinematics::AxisVector axis_acceleration{};  ///< [m/s^2 or rad/s^2]
  kinematics::AxisVector velocity_jump{};      ///< [m/s or rad/s], at once at a corner, besides
  double tip_acceleration = 0;                 ///< [m/s^2]
  double travel_velocity = 0;                  ///< [m/s], G0
  double orientation_velocity = 0;             ///< [rad/s]
  double cycle_time = 0;                       ///< [s]
  machine::PlannerSettings planner;
};
MotionLimits motion_limits(const machine::MachineDescription& machine);

/// [m/s], by which the tip's velocity may change at a corner; infinite where drives may jump. A corner that
/// takes more is passed at less speed (MotionPlanner).
double corner_velocity_change(const MotionLimits& limits);
/// Of chords that stand for a curve: half of it, so that axes, and what is added to the curve, have their
/// part.
constexpr double kChordShare = 0.5;

/// What a pose must satisfy to be planned through.
enum class PoseCheck {
  limits,    ///< every limit of the mechanism
  solvable,  ///< only that there are axis positions for it: to time a program whose findings are known
};

}  // namespace understudy::control

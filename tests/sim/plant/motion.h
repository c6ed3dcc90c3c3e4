// Drive commands for poses of the tool, and the tool pose that kinematics gives to them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

/// What the drives have to do for the tool to be at X_BT and to move with the twist (in B).
inline DriveCommand drive_command(const kinematics::HexapodGeometry& geometry, const Pose& X_BT,
                                  const Twist& twist = Twist::Zero()) {
  kinematics::StrutLengths lengths{};
  Mat6 J;
  EXPECT_EQ(kinematics::inverse(geometry, X_BT, lengths), kinematics::SolveStatus::ok);
  EXPECT_EQ(kinematics::jacobian(geometry, X_BT, J), kinematics::SolveStatus::ok);
  const Twist rates = J * twist;
  DriveCommand command;
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    command.position[s] = lengths[s] - geometry.length_offset[s];
    command.velocity[s] = rates(i);
  }
  return command;
}

/// A circle about a centre at constant orientation: the speed rises over `ramp`, then a turn takes `period`.
struct Circle {
  Pose centre_BT;
  double radius = from_mm(20);
  double period = 2;  // [s]
  double ramp = 0.5;  // [s]

  double phase(double t) const {
    const double turns = t < ramp ? t * t / (2 * ramp) : t - ramp / 2;
    return 2 * std::numbers::pi * turns / period;
  }
  Pose pose(double t) const {
    const double a = phase(t);
    Pose X_BT = centre_BT;
    X_BT.translation() += radius * Vec3(std::cos(a), std::sin(a), 0);
    return X_BT;
  }
  Twist twist(double t) const {
    const double a = phase(t), rate = 2 * std::numbers::pi / period * std::min(t / ramp, 1.0);
    Twist twist = Twist::Zero();
    twist.head<3>() = radius * rate * Vec3(-std::sin(a), std::cos(a), 0);
    return twist;
  }
};

/// The 20 mm circle at 15 degrees of docs/reference.md#mujoco, about the home of the machine.
inline Circle tilted_circle(const machine::MachineDescription& machine) {
  Circle circle;
  circle.centre_BT = machine.X_BT_home;
  circle.centre_BT.linear() = exp_rotation(Vec3(from_deg(15), 0, 0));
  return circle;
}

inline DriveCommand circle_command(const kinematics::HexapodGeometry& geometry, const Circle& circle,
                                   double t) {
  return drive_command(geometry, circle.pose(t), circle.twist(t));
}

inline int steps_for(const Plant& plant, double duration) {
  return static_cast<int>(std::lround(duration / plant.timestep()));
}

}  // namespace understudy::sim

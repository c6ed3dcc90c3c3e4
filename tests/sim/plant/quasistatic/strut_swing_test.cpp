#include "sim/plant/quasistatic/strut_swing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kDeviation = 15e-3;  // [m]
const Vec3 kGravity_B(0.3, -0.2, -9.81);
const Vec3 kTangent = Vec3(0.8, 0.6, 0);
const SwingingBody kMotor{0.3, 2e-4};

/// The ball joint on a smooth way, with its velocity and acceleration.
Vec3 ball_at(double t) {
  return {0.03 + 0.02 * std::sin(3 * t), -0.05 + 0.01 * std::cos(2 * t), -0.2 + 0.03 * std::sin(t)};
}
Vec3 velocity_at(double t) { return {0.06 * std::cos(3 * t), -0.02 * std::sin(2 * t), 0.03 * std::cos(t)}; }
Vec3 acceleration_at(double t) {
  return {-0.18 * std::sin(3 * t), -0.04 * std::cos(2 * t), -0.03 * std::sin(t)};
}

StrutSwing swing_at(double t) {
  StrutSwing swing;
  EXPECT_TRUE(find_swing(ball_at(t), kTangent, kDeviation, swing));
  return swing;
}

/// Of the motor as a rigid body, from where its frame is a little before and after.
double kinetic_energy(double t) {
  constexpr double h = 1e-4;
  const Mat3 before = swing_at(t - h).R_BM, after = swing_at(t + h).R_BM;
  const Vec3 centre_velocity = kDeviation * (after - before).col(0) / (2 * h);
  const Vec3 turning = log_rotation(after * before.transpose()) / (2 * h);
  return 0.5 * kMotor.mass * centre_velocity.squaredNorm() + 0.5 * kMotor.moment * turning.squaredNorm();
}

double energy(double t) {
  return kinetic_energy(t) - kMotor.mass * kGravity_B.dot(kDeviation * swing_at(t).R_BM.col(0));
}

TEST(StrutSwing, ClosesTheStrutBesideItsJoint) {
  for (const double t : {0.0, 0.4, 1.1, 2.5}) {
    const StrutSwing swing = swing_at(t);
    EXPECT_NEAR((swing.R_BM.transpose() * swing.R_BM - Mat3::Identity()).norm(), 0, 1e-12);
    EXPECT_NEAR(swing.R_BM.determinant(), 1, 1e-12);
    EXPECT_NEAR((swing.R_BM * Vec3(kDeviation, 0, swing.length) - ball_at(t)).norm(), 0, 1e-15);
    EXPECT_NEAR(swing.length, std::sqrt(ball_at(t).squaredNorm() - kDeviation * kDeviation), 1e-15);
    EXPECT_NEAR(swing.R_BM.col(0).dot(kTangent), 0, 1e-12) << "the offset is square to the first axis";
    EXPECT_NEAR((swing.R_BM * swing.tangent_M - kTangent).norm(), 0, 1e-12);
  }
}

TEST(StrutSwing, ThereIsNoneAlongTheFirstAxisOrWithinTheOffset) {
  StrutSwing swing;
  EXPECT_FALSE(find_swing(0.2 * kTangent, kTangent, kDeviation, swing));
  EXPECT_FALSE(find_swing(0.2 * kTangent + Vec3(0, 0, 0.9 * kDeviation), kTangent, kDeviation, swing));
  EXPECT_FALSE(find_swing(Vec3(0, 0, 0.9 * kDeviation), kTangent, kDeviation, swing));
  EXPECT_TRUE(find_swing(Vec3(0, 0, 1.1 * kDeviation), kTangent, kDeviation, swing));
}

TEST(StrutSwing, AStrutThroughItsJointFeelsItsMomentOverTheLengthSquared) {
  StrutSwing swing;
  ASSERT_TRUE(find_swing({0, 0, -0.2}, Vec3::UnitX(), 0, swing));
  const Mat3 expected = Vec3(2e-4 / 0.04, 2e-4 / 0.04, 0).asDiagonal();
  EXPECT_NEAR((swing_inertia(swing, {0.3, 2e-4}) - expected).norm(), 0, 1e-15);
  EXPECT_NEAR(swing_force(swing, {0.3, 2e-4}, Vec3::Zero(), Vec3::Zero(), kGravity_B).norm(), 0, 1e-15)
      << "its weight hangs in the joint";
}

TEST(StrutSwing, AtRestItsWeightIsCarriedByLevers) {
  // The strut hangs down, the motor stands off by dev along x; its weight along -z turns it about y.
  StrutSwing swing;
  ASSERT_TRUE(find_swing({kDeviation, 0, -0.2}, Vec3::UnitY(), kDeviation, swing));
  const Vec3 force = swing_force(swing, kMotor, Vec3::Zero(), Vec3::Zero(), {0, 0, -9.81});
  EXPECT_NEAR(std::abs(force.x()), 0.3 * 9.81 * kDeviation / 0.2, 1e-12);
  EXPECT_NEAR(std::abs(force.y()), 0, 1e-12);
  // Lifting the motor by a little does the work of its weight.
  const Vec3 aside(1e-7, 0, 0);
  StrutSwing moved;
  ASSERT_TRUE(find_swing(Vec3(kDeviation, 0, -0.2) + aside, Vec3::UnitY(), kDeviation, moved));
  const double lift = kDeviation * (moved.R_BM.col(0) - swing.R_BM.col(0)).z();
  EXPECT_NEAR(force.dot(aside), -0.3 * 9.81 * lift, 1e-12);
}

TEST(StrutSwing, TheInertiaAtTheBallIsThatOfTheMotorsMotion) {
  for (const double t : {0.1, 0.7, 1.9}) {
    const Vec3 v = velocity_at(t);
    const double felt = 0.5 * v.dot(swing_inertia(swing_at(t), kMotor) * v);
    EXPECT_NEAR(felt / kinetic_energy(t), 1, 1e-6) << t;  // differences over 0.1 ms
  }
}

TEST(StrutSwing, WhatTheBallJointGivesIsWhatTheMotorGains) {
  constexpr double h = 1e-3;
  for (const double t : {0.1, 0.5, 0.9, 1.4, 2.2}) {
    const Vec3 force = swing_force(swing_at(t), kMotor, velocity_at(t), acceleration_at(t), kGravity_B);
    const double gain = (energy(t + h) - energy(t - h)) / (2 * h);
    const double scale = force.norm() * velocity_at(t).norm();
    EXPECT_NEAR(-force.dot(velocity_at(t)), gain, 1e-4 * scale) << t;  // differences over 1 ms of rates 3/s
  }
}

}  // namespace
}  // namespace understudy::sim

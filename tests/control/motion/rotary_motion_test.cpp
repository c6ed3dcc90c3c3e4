// Lines that name B and C: these run linearly, the tip straight over the work, and the slides follow.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/motion/constraint_check.h"
#include "core/error.h"
#include "core/units.h"
#include "tests/control/five_axis_for_test.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using kinematics::LimitKind;
using kinematics::SolveStatus;

constexpr std::size_t kB = 3, kC = 4;

const FiveAxisForTest& printer() {
  static const FiveAxisForTest five_axis;
  return five_axis;
}

// The slides by hand: back through both turns, about their axes (docs/reference.md#five-axis-printer with
// pivots).
Vec3 slides(const Vec3& p_WT, double b, double c) {
  const auto& g = printer().machine.chain().kinematics.parameters;
  const Vec3 b_axis(g[0], 0, g[1]), c_axis(g[2], g[3], 0);
  const Vec3 turned = c_axis + Eigen::AngleAxisd(-c, Vec3::UnitZ()) * (p_WT - c_axis);
  return b_axis + Eigen::AngleAxisd(-b, Vec3::UnitY()) * (turned - b_axis);
}

// No axis changes its place faster than its drive moves, nor its speed faster than it may: what a cycle's
// beginning and end tell, to a thousandth for the rounding of times.
void expect_within_limits(const std::vector<PlannedPoint>& points) {
  const MotionLimits& limits = printer().limits;
  for (std::size_t k = 1; k < points.size(); ++k)
    for (std::size_t i = 0; i < 5; ++i) {
      const auto &now = points[k].setpoint, &before = points[k - 1].setpoint;
      ASSERT_LE(std::abs(now.velocity[i]), 1.001 * limits.axis_velocity[i])
          << "axis " << i << " at " << now.time;
      ASSERT_LE(std::abs(now.position[i] - before.position[i]),
                1.001 * limits.axis_velocity[i] * limits.cycle_time)
          << "axis " << i << " at " << now.time;
      // Bending within a piece of a degree adds its square: 1.5e-4.
      ASSERT_LE(std::abs(now.velocity[i] - before.velocity[i]),
                1.001 * (limits.axis_acceleration[i] * limits.cycle_time + limits.velocity_jump[i]))
          << "axis " << i << " at " << now.time;
    }
}

TEST(RotaryMotion, AConeIsRunWithBConstantAndCLinear) {
  const auto points = printer().plan("G0 X10 Y0 Z20 B30\nG1 X20 Y5 Z22 C720 F300\n");
  const Vec3 from(0.010, 0, 0.020), to(0.020, 0.005, 0.022);
  std::size_t seen = 0;
  for (const PlannedPoint& point : points) {
    if (point.setpoint.line != 2) continue;
    ++seen;
    const double f = point.fraction, b = from_deg(30), c = f * from_deg(720);
    const Vec3 p = from + f * (to - from), q = slides(p, b, c);
    for (int i = 0; i < 3; ++i)
      ASSERT_NEAR(point.setpoint.position[static_cast<std::size_t>(i)], q[i], 1e-12);
    ASSERT_NEAR(point.setpoint.position[kB], b, 1e-12);
    ASSERT_NEAR(point.setpoint.position[kC], c, 1e-9);
    // What the axes make, by products of exponentials, is the pose that is told.
    Pose made;
    ASSERT_EQ(printer().mechanism->forward(point.setpoint.position, printer().X_WT_home, made),
              SolveStatus::ok);
    ASSERT_LT((made.matrix() - point.X_WT.matrix()).norm(), 1e-12);
    ASSERT_LT((point.X_WT.translation() - p).norm(), 1e-12);
  }
  EXPECT_GT(seen, 4000u);  // two turns at 180 deg/s
  expect_within_limits(points);
}

TEST(RotaryMotion, VelocitiesAreThoseOfThePositions) {
  const auto points = printer().plan("G0 X10 Y0 Z20 B30\nG1 X20 Y5 Z22 B-25 C-200 F300\n");
  const double dt = printer().limits.cycle_time;
  double largest = 0;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    if (points[k - 1].setpoint.line != 2 || points[k + 1].setpoint.line != 2) continue;
    for (std::size_t i = 0; i < 5; ++i) {
      const double change =
          (points[k + 1].setpoint.position[i] - points[k - 1].setpoint.position[i]) / (2 * dt);
      // A change of acceleration within the two cycles shows as half of it times dt.
      ASSERT_NEAR(points[k].setpoint.velocity[i], change, printer().limits.axis_acceleration[i] * dt);
      largest = std::max(largest, std::abs(change) / printer().limits.axis_velocity[i]);
    }
  }
  EXPECT_GT(largest, 0.4);  // of what a drive may: the test saw motion
}

TEST(RotaryMotion, BPassesZeroWithCKept) {
  const std::string text = "G0 X10 Y4 Z20 B10 C40\nG1 X12 B-10 F300\nG1 X10 B10\n";
  const auto points = printer().plan(text);
  double lowest = 0;
  for (const PlannedPoint& point : points) {
    if (point.setpoint.line == 1) continue;
    ASSERT_NEAR(point.setpoint.position[kC], from_deg(40), 1e-12) << point.setpoint.time;
    const double f = point.setpoint.line == 2 ? point.fraction : 1 - point.fraction;
    ASSERT_NEAR(point.setpoint.position[kB], from_deg(10 - 20 * f), 1e-9);
    lowest = std::min(lowest, point.setpoint.position[kB]);
  }
  EXPECT_NEAR(lowest, from_deg(-10), 1e-3);
  EXPECT_TRUE(check_constraints(printer().program(text), printer().machine).findings.empty());
}

TEST(RotaryMotion, CRunsOverManyTurnsUnderAnUprightToolAndHomeUnwindsThem) {
  const auto points = printer().plan("G1 C3600 F600\nG4 S0.1\nG28\n");
  const double rate = printer().limits.axis_velocity[kC], up = printer().limits.axis_acceleration[kC];
  const double jump = printer().limits.velocity_jump[kC];
  // A ramp up, constant speed, a ramp down to the jump.
  const double turned = from_deg(3600);
  const double ramps = rate / up + (rate - jump) / up;
  const double way = ramps + (turned - (2 * rate * rate - jump * jump) / (2 * up)) / rate;
  double arrived = 0;
  for (const PlannedPoint& point : points) {
    if (point.setpoint.line == 1) arrived = point.setpoint.time;
    if (point.setpoint.line == 2) {
      ASSERT_NEAR(point.setpoint.position[kC], turned, 1e-12);
    }
    ASSERT_LT((point.X_WT.translation() - printer().X_WT_home.translation()).norm(), 1e-12);
  }
  // To the cycles in which they begin and end.
  EXPECT_NEAR(arrived, way, 3e-3);
  EXPECT_NEAR(points.back().setpoint.position[kC], 0, 1e-12);
  EXPECT_NEAR(points.back().setpoint.time, 2 * way + 0.1, 6e-3);
  expect_within_limits(points);
}

TEST(RotaryMotion, TheToolsAxisLeansNoFasterThanItMay) {
  // B alone: 40 degrees at 60 deg/s, though the drive would do 90.
  const auto points = printer().plan("G1 B40 F6000\n");
  const double rate = printer().limits.orientation_velocity;
  double fastest = 0;
  for (const PlannedPoint& point : points) fastest = std::max(fastest, point.setpoint.velocity[kB]);
  EXPECT_NEAR(fastest, rate, 1e-9);
}

TEST(RotaryMotion, AfterAToolAxisTheWordsTurnFromWhereTheTableStands) {
  // (0.5, 0, 0.866) is B 30 C 0; the line after it has the axes go to B -30 C 180, the same pose, linearly.
  const auto points = printer().plan("G1 X10 Z20 F600 I0.5 J0 K0.866025404\nG1 X12 B-30 C180\nG1 X13\n");
  for (const PlannedPoint& point : points) {
    if (point.setpoint.line != 2) continue;
    EXPECT_NEAR(point.setpoint.position[kB], from_deg(30 - 60 * point.fraction), 1e-8);
    EXPECT_NEAR(point.setpoint.position[kC], from_deg(180 * point.fraction), 1e-8);
  }
  EXPECT_NEAR(points.back().setpoint.position[kB], from_deg(-30), 1e-12);
  EXPECT_NEAR(points.back().setpoint.position[kC], from_deg(180), 1e-12);
}

TEST(RotaryMotion, ATurnBeyondItsRangeIsRefusedAndFoundByAxis) {
  const std::string text = "G1 X1 B125 F10\n";
  EXPECT_THAT([&] { printer().plan(text); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("line 1: ")));
  const auto report = check_constraints(printer().program(text), printer().machine);
  // The slide Z is too low there, too.
  EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(), [](const ConstraintFinding& f) {
    return f.violation.kind == LimitKind::joint_limit && std::abs(f.violation.value - from_deg(125)) < 1e-12;
  }));
}

TEST(RotaryMotion, TurnsThatTheMachineOrThePoseDoesNotHaveAreRefused) {
  const HexapodForTest hexapod;
  toolpath::Step step = hexapod.print_to(hexapod.at({0, 0, -0.001}), 0.01, 7);
  step.rotary = {0, 0};
  auto planner = hexapod.planner();
  EXPECT_THAT([&] { planner.push(step); }, ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(
                                               "line 7: rotary words on a machine without rotary axes")));
  auto steps = printer().program("G1 X1 B10 F600\n").steps;
  steps[0].rotary->b = from_deg(11);
  MotionPlanner other(*printer().mechanism, printer().machine.X_WB, printer().limits, {printer().X_WT_home});
  EXPECT_THAT([&] { other.push(steps[0]); }, ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(
                                                 "the pose is not the one that the rotary words make")));
}

}  // namespace
}  // namespace understudy::control

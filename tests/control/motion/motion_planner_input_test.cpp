// What the planner refuses, and in which words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using ::testing::HasSubstr;
using toolpath::Step;
using toolpath::StepKind;

std::string refusal(MotionPlanner& planner, const Step& step) {
  try {
    planner.push(step);
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().line, step.line);
    return error.what();
  }
  return "accepted";
}

// Straight down the strut is sqrt((206 - 25 + z)^2 + 55.41^2 - dev^2) mm.
TEST(MotionPlannerInput, UnreachablePoseNamesLineStrutAndByHowMuch) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const double length = std::sqrt(236 * 236 + 55.408 * 55.408 - 15 * 15);
  const std::string said = refusal(planner, hexapod.print_to(hexapod.at({0, 0, -0.055}), 0.01, 1187));
  char expected[80];
  std::snprintf(expected, sizeof expected, "line 1187: strut 1 is %.1f mm, longer than 240.0 mm", length);
  EXPECT_EQ(said, expected);
  // As before the call: the planner goes on from home.
  EXPECT_TRUE(planner.resting_pose().isApprox(hexapod.X_WT_home));
  const auto points = stream(planner, {hexapod.print_to(hexapod.at({0.001, 0, 0}), 0.01, 2)});
  EXPECT_EQ(points.front().step, 0u);
  EXPECT_TRUE(points.back().X_WT.matrix() == hexapod.at({0.001, 0, 0}).matrix());
}

// Turning about the tool by 52 degrees brings three struts back to the length that they had: half-way they
// are shorter, sqrt(181^2 + (80 - 29)^2 - dev^2) = 187.5 mm, where joint and joint are in one radial plane.
TEST(MotionPlannerInput, PoseOutOfReachBetweenReachableOnesIsRefused) {
  const HexapodForTest hexapod;
  const auto mechanism = hexapod.with_limits(limits_of_turning(0.188));
  MotionPlanner planner(*mechanism, hexapod.machine.X_WB, hexapod.limits, {hexapod.X_WT_home});
  const Pose X_WT = hexapod.at(Vec3::Zero(), {0, 0, from_deg(52)});
  EXPECT_THAT(refusal(planner, hexapod.print_to(X_WT, 0.01, 3)), HasSubstr("mm, shorter than 188.0"));
  const auto wider = hexapod.with_limits(limits_of_turning(0.187));
  MotionPlanner free_planner(*wider, hexapod.machine.X_WB, hexapod.limits, {hexapod.X_WT_home});
  EXPECT_EQ(refusal(free_planner, hexapod.print_to(X_WT, 0.01, 3)), "accepted");
}

TEST(MotionPlannerInput, BadFiguresOfAStepAreRefusedWithTheirLine) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const Pose ok = hexapod.at({0.001, 0, 0});
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(planner, hexapod.print_to(ok, 0, 4)), HasSubstr("line 4: feed is 0.000000 mm/s"));
  EXPECT_THAT(refusal(planner, hexapod.print_to(ok, kNaN, 5)), HasSubstr("line 5: feed"));
  EXPECT_THAT(refusal(planner, hexapod.print_to(hexapod.at({kNaN, 0, 0}), 0.01, 6)), HasSubstr("not finite"));
  Pose skewed = ok;
  skewed.linear()(0, 1) += 0.01;
  EXPECT_THAT(refusal(planner, hexapod.print_to(skewed, 0.01, 7)), HasSubstr("not a rotation"));
  EXPECT_THAT(refusal(planner, hexapod.print_to(ok, 0.01, 8, kNaN)), HasSubstr("filament"));
  Step dwell = hexapod.step(StepKind::dwell, ok, 0, 9);
  dwell.duration = -1;
  EXPECT_THAT(refusal(planner, dwell), HasSubstr("line 9: duration is -1"));
}

TEST(MotionPlannerInput, LimitsThatAllowNoMotionAreRefused) {
  for (const int which : {0, 1, 2, 3, 4, 5}) {
    HexapodForTest hexapod;
    MotionLimits& l = hexapod.limits;
    double* const limits[] = {&l.cycle_time,           &l.tip_acceleration, &l.travel_velocity,
                              &l.orientation_velocity, &l.axis_velocity[2], &l.axis_acceleration[5]};
    *limits[which] = 0;
    EXPECT_THROW(hexapod.planner(), InputError) << which;
  }
}

TEST(MotionPlannerInput, LimitsComeFromTheMachine) {
  const HexapodForTest hexapod;
  const MotionLimits limits = motion_limits(hexapod.machine);
  EXPECT_EQ(limits.axis_velocity[5], hexapod.machine.drives[0].velocity_max);
  EXPECT_EQ(limits.axis_acceleration[0], hexapod.machine.drives[0].acceleration_max);
  EXPECT_EQ(limits.tip_acceleration, hexapod.machine.acceleration);
  EXPECT_EQ(limits.travel_velocity, hexapod.machine.travel_velocity);
  EXPECT_EQ(limits.orientation_velocity, hexapod.machine.orientation_velocity);
  EXPECT_EQ(limits.cycle_time, hexapod.machine.cycle_time);
}

}  // namespace
}  // namespace understudy::control

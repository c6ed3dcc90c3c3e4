#include "control/motion/timed_plan.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

constexpr double kDown = 0.010, kFeed = 0.020;  // [m], [m/s]

// Down by 10 mm and back, each with a ramp at both ends: d / v + v / a, twice.
struct DownAndUp {
  HexapodForTest hexapod;
  toolpath::Step down = hexapod.print_to(hexapod.at({0, 0, -kDown}), kFeed, 1);
  toolpath::Step up = hexapod.print_to(hexapod.at({0, 0, 0}), kFeed, 2);
  double ramp = kFeed / hexapod.limits.tip_acceleration;  // [s]
  double one_way = kDown / kFeed + ramp;
  double cycles = 2.5 * hexapod.limits.cycle_time;
};

TEST(TimedPlan, TellsWhenThePlanComesPastAPlace) {
  const DownAndUp way;
  TimedPlan plan(way.hexapod.machine, way.hexapod.limits);
  plan.find_time(0, {0, 0.5});
  plan.add(way.down);
  plan.find_time(1, {1, 0.25});
  plan.find_time(2, {1, 0.75});
  plan.add(way.up);
  plan.finish();
  const double half_ramp = way.ramp / 2;  // what speeding up has cost by then
  EXPECT_NEAR(plan.time_of(0), 0.5 * kDown / kFeed + half_ramp, way.cycles);
  EXPECT_NEAR(plan.time_of(1), way.one_way + 0.25 * kDown / kFeed + half_ramp, way.cycles);
  EXPECT_NEAR(plan.time_of(2), way.one_way + 0.75 * kDown / kFeed + half_ramp, way.cycles);
  EXPECT_NEAR(plan.duration(), 2 * way.one_way, way.cycles);
}

TEST(TimedPlan, AFindingThatHasMovedHasTheTimeOfItsNewestPlace) {
  const DownAndUp way;
  TimedPlan plan(way.hexapod.machine, way.hexapod.limits);
  plan.find_time(0, {0, 0.25});
  plan.find_time(0, {0, 0.5});  // before the step is planned
  plan.find_time(1, {0, 0.5});
  plan.add(way.down);
  plan.find_time(1, {1, 0.5});  // after the first place was passed
  plan.add(way.up);
  plan.finish();
  EXPECT_NEAR(plan.time_of(0), 0.5 * kDown / kFeed + way.ramp / 2, way.cycles);
  EXPECT_NEAR(plan.time_of(1), way.one_way + 0.5 * kDown / kFeed + way.ramp / 2, way.cycles);
}

TEST(TimedPlan, EndsWhereTheMotionPlannerRefusesAStep) {
  const DownAndUp way;
  TimedPlan plan(way.hexapod.machine, way.hexapod.limits);
  plan.add(way.down);
  // A platform's joint comes to its base joint: nearer than the screw's axis ever is.
  const machine::MachineDescription& machine = way.hexapod.machine;
  const auto& geometry = machine.hexapod().geometry;
  const Vec3 strut_B = geometry.base_joint[0] - machine.X_BT_home * geometry.platform_joint[0];
  const Pose nowhere = way.hexapod.at(machine.X_WB.linear() * strut_B);
  const toolpath::Step to_nowhere = way.hexapod.print_to(nowhere, kFeed, 2);
  plan.find_time(0, {1, 0.5});
  plan.add(to_nowhere);
  plan.add(way.up);
  plan.finish();
  EXPECT_EQ(plan.refused(), std::optional<std::size_t>(1));
  EXPECT_NEAR(plan.duration(), way.one_way, way.cycles);
  EXPECT_EQ(plan.time_of(0), plan.duration());
}

TEST(TimedPlan, OfNothingLastsNoTime) {
  const HexapodForTest hexapod;
  TimedPlan plan(hexapod.machine, hexapod.limits);
  plan.finish();
  EXPECT_EQ(plan.duration(), 0);
  EXPECT_FALSE(plan.refused());
}

}  // namespace
}  // namespace understudy::control

#include "control/motion/motion_planner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random_vector.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using toolpath::Step;
using toolpath::StepKind;

constexpr double kUnlimited = 1e3;
constexpr int kStruts = kinematics::kStruts;

// A motion that takes `duration` ends in the cycle that follows; the last point handed out is the first at
// rest. `late`: what the grid may cost, in cycles.
void expect_duration(const std::vector<PlannedPoint>& points, double duration, double cycle,
                     double late = 0) {
  ASSERT_FALSE(points.empty());
  EXPECT_GE(points.back().setpoint.time, duration - 1e-9);
  EXPECT_LE(points.back().setpoint.time, duration + (1 + late) * cycle + 1e-9);
}

double tip_speed(const PlannedPoint& a, const PlannedPoint& b) {
  return (b.X_WT.translation() - a.X_WT.translation()).norm() / (b.setpoint.time - a.setpoint.time);
}

void expect_at_rest_at(const PlannedPoint& point, const Pose& X_WT) {
  EXPECT_TRUE(point.X_WT.matrix() == X_WT.matrix());
  for (const double v : point.setpoint.velocity) EXPECT_EQ(v, 0);
}

// Tip limits bind: 10 mm at 20 mm/s with 1 m/s^2 take d/v + v/a. The grid of 10 pieces over a speeding-up
// loses at most a few per cent of the 20 ms it takes: one cycle.
TEST(MotionPlanner, StraightMoveTakesTheTimeOfTheTrapezoid) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const double d = 0.010, v = 0.020, a = hexapod.limits.tip_acceleration;
  const Pose X_WT = hexapod.at({0, 0, -d});
  const auto points = stream(planner, {hexapod.print_to(X_WT, v, 1)});
  expect_duration(points, d / v + v / a, hexapod.limits.cycle_time, 1);
  expect_at_rest_at(points.back(), X_WT);
}

// A fifth of the machine's 1 m/s^2, and ten times as much, which the machine does not have.
TEST(MotionPlanner, TheAccelerationOfAStepCountsWhereItIsBelowTheMachines) {
  const HexapodForTest hexapod;
  const double d = 0.010, v = 0.020, a = hexapod.limits.tip_acceleration;
  for (const double programmed : {a / 5, 10 * a}) {
    MotionPlanner planner = hexapod.planner();
    Step step = hexapod.print_to(hexapod.at({0, 0, -d}), v, 1);
    step.acceleration = programmed;
    const double expected = d / v + v / std::min(a, programmed);
    expect_duration(stream(planner, {step}), expected, hexapod.limits.cycle_time, 3);
  }
}

TEST(MotionPlanner, ShortMoveTakesTheTimeOfTheTriangle) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const double d = 0.0004, a = hexapod.limits.tip_acceleration;  // peaks at 20 mm/s
  const auto points = stream(planner, {hexapod.print_to(hexapod.at({0, 0, -d}), 0.05, 1)});
  expect_duration(points, 2 * std::sqrt(d / a), hexapod.limits.cycle_time, 1);
}

// Along z from home all struts move alike, so the best time is that of a trapezoid in the strut's own length.
TEST(MotionPlanner, StrutLimitsGiveTheTimeOfTheTrapezoidInStrutLength) {
  HexapodForTest hexapod;
  hexapod.limits.tip_acceleration = kUnlimited;
  hexapod.limits.axis_velocity.fill(0.012);
  hexapod.limits.axis_acceleration.fill(0.3);
  MotionPlanner planner = hexapod.planner();
  const Pose X_WT = hexapod.at({0, 0, -0.03});
  kinematics::AxisVector from{}, to{};
  const Pose X_BW = hexapod.machine.X_WB.inverse();
  ASSERT_EQ(hexapod.mechanism->inverse(X_BW * hexapod.X_WT_home, {}, from), kinematics::SolveStatus::ok);
  ASSERT_EQ(hexapod.mechanism->inverse(X_BW * X_WT, {}, to), kinematics::SolveStatus::ok);
  const auto points = stream(planner, {hexapod.print_to(X_WT, 1.0, 1)});
  // Slopes are linear over a piece of 0.5 mm to 1e-5: well below the cycle that the grid may cost at either
  // end.
  expect_duration(points, (to[0] - from[0]) / 0.012 + 0.012 / 0.3, hexapod.limits.cycle_time, 2);
  double fastest = 0;
  for (const auto& p : points) fastest = std::max(fastest, p.setpoint.velocity[3]);
  EXPECT_NEAR(fastest, 0.012, 1e-6);
}

std::vector<Step> random_program(const HexapodForTest& hexapod, Random& random, int count) {
  std::vector<Step> steps;
  for (int n = 1; n <= count; ++n) {
    const double size = std::pow(10.0, random.uniform(-4.0, -1.9));  // [m], 0.1 to 12 mm between the points
    Vec3 p = uniform_vec3(random, size);
    Vec3 turn(random.uniform(-8, 8) * size, random.uniform(-8, 8) * size, random.uniform(-8, 8) * size);
    steps.push_back(hexapod.print_to(hexapod.at(p, turn), random.uniform(0.002, 0.15), n, 1e-4));
    if (n % 17 == 0) steps.back().kind = StepKind::travel;
  }
  return steps;
}

// What a drive sees: first and second differences of the positions, and of the velocities that come with
// them. By the mean value theorem they are averages of what the planner bounds; the rest is that slopes are
// taken as linear over a piece, 1e-3 of the limit.
void expect_within_limits(const std::vector<PlannedPoint>& points, const HexapodForTest& hexapod,
                          double acceleration_slack) {
  const MotionLimits& limits = hexapod.limits;
  const double T = limits.cycle_time;
  for (std::size_t n = 2; n < points.size(); ++n) {
    const auto &a = points[n - 2].setpoint, &b = points[n - 1].setpoint, &c = points[n].setpoint;
    for (std::size_t i = 0; i < kStruts; ++i) {
      const double v_max = limits.axis_velocity[i], a_max = limits.axis_acceleration[i];
      ASSERT_LE(std::abs(c.velocity[i]), v_max * 1.001) << "point " << n << " line " << c.line;
      ASSERT_LE(std::abs(c.position[i] - b.position[i]) / T, v_max * 1.001)
          << "point " << n << " line " << c.line;
      ASSERT_LE(std::abs(c.velocity[i] - b.velocity[i]) / T, a_max * acceleration_slack)
          << "point " << n << " line " << c.line << " strut " << i + 1;
      ASSERT_LE(std::abs(c.position[i] - 2 * b.position[i] + a.position[i]) / (T * T),
                a_max * acceleration_slack)
          << "point " << n << " line " << c.line << " strut " << i + 1;
    }
    const Vec3 tip = (points[n].X_WT.translation() - 2 * points[n - 1].X_WT.translation() +
                      points[n - 2].X_WT.translation()) /
                     (T * T);
    ASSERT_LE(tip.norm(), limits.tip_acceleration * acceleration_slack)
        << "point " << n << " line " << c.line;
  }
}

TEST(MotionPlanner, NoAxisExceedsVelocityOrAcceleration) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    HexapodForTest hexapod;
    Random random(seed, "random program");
    if (seed > 2) hexapod.limits.axis_velocity.fill(0.02), hexapod.limits.axis_acceleration.fill(0.4);
    MotionPlanner planner = hexapod.planner();
    const auto points = stream(planner, random_program(hexapod, random, 150));
    expect_within_limits(points, hexapod, 1.001);
  }
}

// A scanned or badly exported path: 3 to 30 um between points, off the line by as much, several corners in a
// cycle.
TEST(MotionPlanner, NoAxisExceedsItsLimitsOnARaggedPathOfTinySteps) {
  const HexapodForTest hexapod;
  Random random(7, "ragged");
  std::vector<Step> steps;
  Vec3 p(0, 0, 0);
  for (int n = 1; n <= 1500; ++n) {
    const double chord = random.uniform(3e-6, 30e-6), off = (n / 300 % 2 == 0 ? 1.0 : 0.05) * chord;
    p += Vec3(chord, random.uniform(-off, off), random.uniform(-off, off));
    steps.push_back(hexapod.print_to(hexapod.at(p, {random.uniform(-off, off) * 20, 0, 0}), 0.05, n));
  }
  MotionPlanner planner = hexapod.planner();
  const auto points = stream(planner, steps);
  // Corners are gathered over the speed at one of them; between them the tip speeds up a little: 2 %.
  expect_within_limits(points, hexapod, 1.02);
  EXPECT_LT(points.back().setpoint.time, 20);  // it does creep, but it moves
}

// Velocity is the derivative of position: over a cycle the mean of both ends' velocities gives the step, but
// for a switch of acceleration within the cycle, at most a T^2 / 4.
TEST(MotionPlanner, VelocitiesBelongToPositions) {
  const HexapodForTest hexapod;
  Random random(5, "random program");
  MotionPlanner planner = hexapod.planner();
  const auto points = stream(planner, random_program(hexapod, random, 100));
  const double T = hexapod.limits.cycle_time;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const auto &a = points[n - 1].setpoint, &b = points[n].setpoint;
    for (std::size_t i = 0; i < kStruts; ++i)
      ASSERT_NEAR(b.position[i] - a.position[i], 0.5 * T * (a.velocity[i] + b.velocity[i]),
                  hexapod.limits.axis_acceleration[i] * T * T / 4);
  }
}

// Every point lies on its step's straight line and shortest arc, and the points run through the steps in
// order: so the path goes through each programmed pose and rounds no corner.
TEST(MotionPlanner, PathGoesThroughEveryProgrammedPose) {
  const HexapodForTest hexapod;
  Random random(6, "random program");
  const auto steps = random_program(hexapod, random, 100);
  MotionPlanner planner = hexapod.planner(2.5);
  const auto points = stream(planner, steps);
  std::size_t step = 0;
  double fraction = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const PlannedPoint& p = points[n];
    ASSERT_TRUE(p.step > step || (p.step == step && p.fraction >= fraction));
    step = p.step, fraction = p.fraction;
    const Pose& from = step == 0 ? hexapod.X_WT_home : steps[step - 1].X_WT;
    const Pose expected = interpolate(from, steps[step].X_WT, fraction);
    ASSERT_LE((p.X_WT.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-13);
    ASSERT_EQ(p.setpoint.line, steps[step].line);
    ASSERT_EQ(p.setpoint.time, 2.5 + static_cast<double>(n + 1) * hexapod.limits.cycle_time);
    kinematics::AxisVector axes{};
    ASSERT_EQ(hexapod.mechanism->inverse(hexapod.machine.X_WB.inverse() * p.X_WT, {}, axes),
              kinematics::SolveStatus::ok);
    ASSERT_EQ(axes, p.setpoint.position);
  }
  expect_at_rest_at(points.back(), steps.back().X_WT);
  EXPECT_EQ(planner.time(), points.back().setpoint.time);
}

double speed_at_corner(double angle) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const Vec3 corner(0.01, 0, 0), after(0.01 + 0.01 * std::cos(angle), 0.01 * std::sin(angle), 0);
  const auto points = stream(
      planner, {hexapod.print_to(hexapod.at(corner), 0.02, 1), hexapod.print_to(hexapod.at(after), 0.02, 2)});
  std::size_t n = 1;
  while (points[n].setpoint.line == 1) ++n;
  return tip_speed(points[n - 1], points[n]);
}

// The tip's velocity turns within one cycle T by v * 2 sin(angle/2), at most half of a T by the header; the
// mean over the cycle around the corner is faster by the other half at most.
TEST(MotionPlanner, SharpCornerIsTakenSlowlyAndAStraightJointAtFullSpeed) {
  const HexapodForTest hexapod;
  const double a_T = hexapod.limits.tip_acceleration * hexapod.limits.cycle_time;
  for (const double angle : {from_deg(30), from_deg(90), from_deg(179)}) {
    const double expected = 0.5 * a_T / (2 * std::sin(angle / 2));
    EXPECT_LE(speed_at_corner(angle), expected + 0.5 * a_T) << angle;
    EXPECT_GE(speed_at_corner(angle), 0.5 * expected * std::cos(angle / 2))
        << angle;  // chord across the corner
  }
  EXPECT_NEAR(speed_at_corner(0), 0.02, 1e-9);
}

// 15 mm radius in chords of 0.2 mm at 10 mm/s: the corner of 0.013 rad asks for 0.13 of the 1 mm/s that one
// cycle allows, so nothing needs to slow down.
TEST(MotionPlanner, ArcOfFineChordsRunsAtTheFeedWithoutStutter) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  std::vector<Step> steps;
  const double radius = 0.015, feed = 0.010;
  for (int n = 1; n <= 300; ++n) {
    const double angle = n * 0.2e-3 / radius;
    // The tool leans outwards on the way, as on the bottle.
    const Vec3 turn = 0.2 * Vec3(-std::sin(angle), std::cos(angle) - 1, 0);
    steps.push_back(
        hexapod.print_to(hexapod.at(radius * Vec3(std::sin(angle), 1 - std::cos(angle), 0), turn), feed, n));
  }
  const auto points = stream(planner, steps);
  double length = 0;
  const double run_up = 2 * feed / hexapod.limits.tip_acceleration, end = points.back().setpoint.time;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const double t = points[n].setpoint.time, speed = tip_speed(points[n - 1], points[n]);
    length += (points[n].X_WT.translation() - points[n - 1].X_WT.translation()).norm();
    if (t > run_up && t < end - run_up) {
      ASSERT_NEAR(speed, feed, 0.01 * feed) << "time " << t;
    }
  }
  EXPECT_GT(length, 0.059);
  expect_within_limits(points, hexapod, 1.001);
}

TEST(MotionPlanner, FeedOfTheNextStepHoldsFromItsFirstPoint) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const auto points = stream(planner, {hexapod.print_to(hexapod.at({0.01, 0, 0}), 0.04, 1),
                                       hexapod.print_to(hexapod.at({0.012, 0, 0}), 0.005, 2)});
  double fastest[3] = {0, 0, 0};
  for (std::size_t n = 1; n < points.size(); ++n)
    if (points[n - 1].setpoint.line == points[n].setpoint.line)
      fastest[points[n].setpoint.line] =
          std::max(fastest[points[n].setpoint.line], tip_speed(points[n - 1], points[n]));
  EXPECT_NEAR(fastest[1], 0.04, 1e-9);
  EXPECT_NEAR(fastest[2], 0.005, 1e-9);
}

TEST(MotionPlanner, InverseTimeFeedAndDwellTakeTheirTime) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  Step timed = hexapod.print_to(hexapod.at({0.01, 0, 0}), 0, 1);
  timed.duration = 2;
  Step dwell = hexapod.step(StepKind::dwell, timed.X_WT, 0, 2);
  dwell.duration = 0.5;
  const auto points = stream(planner, {timed, dwell});
  const double v = 0.01 / 2;
  expect_duration(points, 2 + v / hexapod.limits.tip_acceleration + 0.5, hexapod.limits.cycle_time, 1);
  int at_rest = 0;
  for (const auto& p : points) at_rest += p.setpoint.line == 2;
  EXPECT_NEAR(at_rest, 500, 1);
}

TEST(MotionPlanner, PureTurnRunsAtTheAngularSpeedOfTheTool) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const auto points =
      stream(planner, {hexapod.print_to(hexapod.at(Vec3::Zero(), {from_deg(20), 0, 0}), 0.05, 1)});
  double fastest = 0;
  for (std::size_t n = 1; n < points.size(); ++n)
    fastest = std::max(fastest, angle_between(points[n - 1].X_WT.linear(), points[n].X_WT.linear()) / 1e-3);
  EXPECT_LE(fastest, hexapod.limits.orientation_velocity * 1.000001);
  EXPECT_GE(points.back().setpoint.time, from_deg(20) / hexapod.limits.orientation_velocity);
  expect_within_limits(points, hexapod, 1.001);
}

TEST(MotionPlanner, TravelRunsAtTheTravelVelocityWhateverTheFeed) {
  HexapodForTest hexapod;
  hexapod.limits.axis_velocity.fill(kUnlimited), hexapod.limits.axis_acceleration.fill(kUnlimited);
  MotionPlanner planner = hexapod.planner();
  const double d = 0.02, v = hexapod.limits.travel_velocity, a = hexapod.limits.tip_acceleration;
  const auto points = stream(planner, {hexapod.step(StepKind::travel, hexapod.at({d, 0, 0}), 0.001, 1)});
  expect_duration(points, d / v + v / a, hexapod.limits.cycle_time, 2);
}

TEST(MotionPlanner, FilamentFollowsThePathWithinAStepAndRetractsAtRest) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  Step retract = hexapod.step(StepKind::move, hexapod.at({0.01, 0, 0}), 0.04, 2);
  retract.filament = -0.002;
  const auto points = stream(planner, {hexapod.print_to(hexapod.at({0.01, 0, 0}), 0.01, 1, 0.003), retract});
  double retracting = 0;
  for (const auto& p : points) {
    const double travelled = p.X_WT.translation().x() - hexapod.X_WT_home.translation().x();
    if (p.setpoint.line == 1) {
      ASSERT_NEAR(p.setpoint.filament, 0.003 * travelled / 0.01, 1e-15);
    } else {
      retracting += hexapod.limits.cycle_time;
    }
  }
  EXPECT_NEAR(retracting, 0.002 / 0.04, 1.5 * hexapod.limits.cycle_time);
  EXPECT_EQ(points.back().setpoint.filament, 0.003 + -0.002);
}

TEST(MotionPlanner, MotionGoesOnAfterFinish) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  const auto first = stream(planner, {hexapod.print_to(hexapod.at({0.01, 0, 0}), 0.01, 1)});
  PlannedPoint point;
  EXPECT_FALSE(planner.next(point));
  EXPECT_TRUE(planner.resting_pose().isApprox(hexapod.at({0.01, 0, 0})));
  const auto second = stream(planner, {hexapod.print_to(hexapod.at({0.02, 0, 0}), 0.01, 2)});
  EXPECT_NEAR(second.front().setpoint.time, first.back().setpoint.time + hexapod.limits.cycle_time, 1e-12);
  expect_duration(second, first.back().setpoint.time + 1 + 0.01, hexapod.limits.cycle_time, 1);
  EXPECT_FALSE(planner.next(point));
}

TEST(MotionPlanner, FinishStopsThereEvenIfMoreIsPushedBeforeItIsTaken) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  planner.push(hexapod.print_to(hexapod.at({0.01, 0, 0}), 0.01, 1));
  planner.finish();
  planner.push(hexapod.print_to(hexapod.at({0.02, 0, 0}), 0.01, 2));
  planner.finish();
  std::vector<PlannedPoint> points;
  take_all(planner, points);
  expect_duration(points, 2 * (1 + 0.01), hexapod.limits.cycle_time, 2);
  double slowest = 1;
  for (std::size_t n = 900; n < 1100; ++n) slowest = std::min(slowest, tip_speed(points[n], points[n + 1]));
  EXPECT_LT(slowest, hexapod.limits.tip_acceleration * hexapod.limits.cycle_time);
}

TEST(MotionPlanner, NothingToDoGivesNoPoint) {
  const HexapodForTest hexapod;
  MotionPlanner planner = hexapod.planner();
  EXPECT_TRUE(stream(planner, {}).empty());
  EXPECT_TRUE(stream(planner, {hexapod.print_to(hexapod.X_WT_home, 0.01, 1)}).empty());
  Step heat = hexapod.step(StepKind::temperature, Pose::Identity(), 0, 2);
  EXPECT_TRUE(stream(planner, {heat}).empty());
}

}  // namespace
}  // namespace understudy::control

#include "control/motion/constraint_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using kinematics::LimitKind;
using toolpath::Program;
using toolpath::StepKind;

Program program_of(const std::vector<toolpath::Step>& steps) {
  Program program;
  program.file = "hand-made.gcode";
  program.steps = steps;
  return program;
}

std::vector<ConstraintFinding> of_kind(const ConstraintReport& report, LimitKind kind) {
  std::vector<ConstraintFinding> found;
  std::copy_if(report.findings.begin(), report.findings.end(), std::back_inserter(found),
               [&](const ConstraintFinding& f) { return f.violation.kind == kind; });
  return found;
}

// Straight below home: every strut is the hypotenuse over the drop and the 55.41 mm run, less dev.
double strut_below_home(double down) {
  const double run2 = 0.080 * 0.080 + 0.029 * 0.029 - 2 * 0.080 * 0.029 * std::cos(from_deg(26));
  return std::sqrt((0.181 + down) * (0.181 + down) + run2 - 0.015 * 0.015);
}

TEST(ConstraintCheck, ProgramWithinLimitsHasNoFindingAndItsRangesAreKnown) {
  const HexapodForTest hexapod;
  const double down = 0.010, feed = 0.020;
  const auto report = check_constraints(program_of({hexapod.print_to(hexapod.at({0, 0, -down}), feed, 1),
                                                    hexapod.step(StepKind::end, {}, 0, 2)}),
                                        hexapod.machine);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_NEAR(report.duration, down / feed + feed / hexapod.limits.tip_acceleration, 2e-3);  // two cycles
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_NEAR(report.axis_min[i], strut_below_home(0), 1e-9);
    EXPECT_NEAR(report.axis_max[i], strut_below_home(down), 1e-9);
    // The strut's slope against the vertical turns tip speed into strut speed; it is largest at the low end,
    // where the tip stops: between the slopes at both ends.
    EXPECT_GE(report.velocity_max[i], feed * 0.181 / strut_below_home(0));
    EXPECT_LE(report.velocity_max[i], feed * (0.181 + down) / strut_below_home(down));
    EXPECT_LE(report.acceleration_max[i],
              1.0 * hexapod.limits.tip_acceleration);  // struts are slower than the tip
    EXPECT_GE(report.acceleration_max[i], 0.9 * hexapod.limits.tip_acceleration);
  }
  EXPECT_EQ(report.axis_max[7], 0);
  EXPECT_GE(report.condition_worst, 6.1);  // docs/reference.md#machine-g4 at home
  EXPECT_LE(report.condition_worst, 10);
}

TEST(ConstraintCheck, StrutTooLongIsFoundAtItsLineWithValueLimitAndTime) {
  const HexapodForTest hexapod;
  const auto report = check_constraints(program_of({hexapod.print_to(hexapod.at({0, 0, -0.010}), 0.02, 11),
                                                    hexapod.print_to(hexapod.at({0, 0, -0.056}), 0.02, 12),
                                                    hexapod.print_to(hexapod.at({0, 0, -0.010}), 0.02, 13)}),
                                        hexapod.machine);
  const auto found = of_kind(report, LimitKind::strut_length);
  ASSERT_EQ(found.size(), 6u);  // six struts, on the way down and on the way up that follows
  std::set<std::string> parts;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(found[k].line, 12);
    EXPECT_EQ(found[k].last_line, 13);
    EXPECT_NEAR(found[k].violation.value, strut_below_home(0.056), 1e-9);  // the worst of the line is its end
    EXPECT_EQ(found[k].violation.limit, hexapod.machine.hexapod().limits.strut_max);
    EXPECT_NEAR(found[k].time, 0.056 / 0.02 + 0.02, 3e-3);  // d/v and two ramps, to cycles
    EXPECT_EQ(found[k].reduced_feed, 0);
    parts.insert(found[k].violation.part);
  }
  EXPECT_EQ(parts.size(), 6u);
  EXPECT_EQ(parts.count("strut 3"), 1u);
}

// An independent computation finds the ball joint's 60 deg at 25.7 deg of tilt towards azimuth 15 deg.
TEST(ConstraintCheck, JointAngleIsFound) {
  const HexapodForTest hexapod;
  const double azimuth = from_deg(15);
  const auto lean = [&](double tilt) {
    return hexapod.at(Vec3::Zero(), tilt * Vec3(std::cos(azimuth), std::sin(azimuth), 0));
  };
  const auto inside =
      check_constraints(program_of({hexapod.print_to(lean(from_deg(25.6)), 0.02, 1)}), hexapod.machine);
  EXPECT_TRUE(inside.findings.empty());
  const auto report =
      check_constraints(program_of({hexapod.print_to(lean(from_deg(26)), 0.02, 7)}), hexapod.machine);
  ASSERT_EQ(report.findings.size(), 1u);
  const ConstraintFinding& f = report.findings[0];
  EXPECT_EQ(f.violation.kind, LimitKind::joint_angle);
  EXPECT_EQ(f.violation.part.substr(0, 10), "ball joint");
  EXPECT_EQ(f.line, 7);
  EXPECT_LT(f.violation.value, from_deg(60));
  EXPECT_NEAR(f.violation.limit, from_deg(60), 1e-12);
  EXPECT_GT(f.time, 0);
}

TEST(ConstraintCheck, ScrewsTooNearAreFound) {
  HexapodForTest hexapod;
  hexapod.machine.hexapod().limits.screw_distance_min = 0.018;
  const auto report =
      check_constraints(program_of({hexapod.print_to(hexapod.at({1e-4, 0, 0}), 0.01, 4)}), hexapod.machine);
  std::set<std::string> parts;
  for (const auto& f : of_kind(report, LimitKind::screw_distance)) {
    if (f.line != 4) continue;  // line 0: home, where the program starts
    parts.insert(f.violation.part);
    EXPECT_NEAR(f.violation.value, 2 * 0.029 * std::sin(from_deg(17)),
                1e-5);  // chord between two ball joints
    EXPECT_EQ(f.violation.limit, 0.018);
    EXPECT_EQ(f.violation.unit, "m");
  }
  EXPECT_EQ(parts, (std::set<std::string>{"struts 1 and 2", "struts 3 and 4", "struts 5 and 6"}));
}

TEST(ConstraintCheck, BadConditioningIsFound) {
  HexapodForTest hexapod;
  hexapod.machine.hexapod().limits.condition_max = 6.0;  // home has 6.1, docs/reference.md#machine-g4
  const auto report =
      check_constraints(program_of({hexapod.print_to(hexapod.at({1e-4, 0, 0}), 0.01, 5)}), hexapod.machine);
  const auto found = of_kind(report, LimitKind::singularity);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].line, 5);
  EXPECT_NEAR(found[1].violation.value, 6.1, 0.05);
  EXPECT_EQ(found[1].violation.limit, 6.0);
}

// See the planner's test of the same turn: half-way three struts are 187.45 mm.
TEST(ConstraintCheck, PosesBetweenProgrammedPointsAreChecked) {
  HexapodForTest hexapod;
  hexapod.machine.hexapod().limits = limits_of_turning(0.188);
  const auto report = check_constraints(
      program_of({hexapod.print_to(hexapod.at(Vec3::Zero(), {0, 0, from_deg(52)}), 0.01, 9)}),
      hexapod.machine);
  ASSERT_EQ(report.findings.size(), 3u);
  for (const ConstraintFinding& f : report.findings) {
    EXPECT_NEAR(f.violation.value, std::sqrt(0.181 * 0.181 + 0.051 * 0.051 - 0.015 * 0.015),
                1e-7);  // one degree apart
    EXPECT_EQ(f.violation.limit, 0.188);
    EXPECT_NEAR(f.time, report.duration / 2, 0.02);  // half the turn; ramps are alike
  }
}

TEST(ConstraintCheck, FeedThatAnAxisCutsBelowHalfIsAWarningWithTheSpeedItNeeds) {
  const HexapodForTest hexapod;
  const Pose low = hexapod.at({0, 0, -0.020}), high = hexapod.X_WT_home;
  const double v_max = hexapod.limits.axis_velocity[0];
  const auto report =
      check_constraints(program_of({
                            hexapod.print_to(low, 1.5 * v_max, 1),     // cut, but to more than half
                            hexapod.print_to(high, 5 * v_max, 2),      // cut to about a fifth
                            hexapod.step(StepKind::travel, low, 0, 3)  // as fast as it goes anyway
                        }),
                        hexapod.machine);
  ASSERT_EQ(report.findings.size(), 6u);
  for (const ConstraintFinding& f : report.findings) {
    EXPECT_EQ(f.line, 2);
    EXPECT_EQ(f.violation.kind, LimitKind::axis_velocity);
    EXPECT_EQ(f.violation.limit, v_max);
    // Worst where the struts are steepest, at the low end; the first pose looked at is 0.5 mm up.
    EXPECT_NEAR(f.violation.value, 5 * v_max * 0.201 / strut_below_home(0.020), 1e-3 * v_max);
    EXPECT_NEAR(f.reduced_feed, v_max / f.violation.value, 1e-12);
  }
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) EXPECT_LE(report.velocity_max[i], 1.001 * v_max);
}

TEST(ConstraintCheck, PathThroughNoSolutionGivesFindingsAndGoesOn) {
  const HexapodForTest hexapod;
  // Ball joint 3 at base joint 3: nearer than dev, no strut length exists.
  const auto& g = hexapod.machine.hexapod().geometry;
  const Pose X_WT =
      hexapod.machine.X_WB * make_pose(Mat3(Mat3::Identity()), g.base_joint[2] - g.platform_joint[2]);
  ConstraintReport report;
  ASSERT_NO_THROW(
      report = check_constraints(
          program_of({hexapod.print_to(hexapod.at({0, 0, -0.002}), 0.01, 1), hexapod.print_to(X_WT, 0.01, 2),
                      hexapod.print_to(hexapod.X_WT_home, 0.01, 3),
                      hexapod.print_to(hexapod.at({0, 0, -0.055}), 0.01, 4)}),
          hexapod.machine));
  const auto unreachable = of_kind(report, LimitKind::unreachable);
  ASSERT_FALSE(unreachable.empty());
  const bool names_strut_3 =
      std::any_of(unreachable.begin(), unreachable.end(), [&](const ConstraintFinding& f) {
        return f.line == 2 && f.violation.part == "strut 3" && f.violation.value < 1e-12 &&
               f.violation.limit == g.deviation;
      });
  EXPECT_TRUE(names_strut_3);
  const auto lengths = of_kind(report, LimitKind::strut_length);
  // Checked on after the plan's end: line 4 is too low, in a run of lines of which one may be worse.
  const double least = strut_below_home(0.055) - hexapod.machine.hexapod().limits.strut_max;
  EXPECT_TRUE(std::any_of(lengths.begin(), lengths.end(), [&](const auto& f) {
    return f.last_line == 4 && std::abs(f.violation.value - f.violation.limit) > least - 1e-9;
  }));
  EXPECT_TRUE(std::is_sorted(report.findings.begin(), report.findings.end(),
                             [](const auto& a, const auto& b) { return a.line < b.line; }));
  EXPECT_NEAR(report.duration, 0.2 + 0.01, 2e-3);  // what can be planned: the first line
  // The way there and the way from there.
  EXPECT_EQ(report.impossible, (std::vector<std::size_t>{1, 2}));
}

// The first pose that is looked at behind the place may be one that axes reach again.
TEST(ConstraintCheck, AMoveThatBeginsWhereNoAxesReachIsImpossible) {
  const HexapodForTest hexapod;
  const auto& g = hexapod.machine.hexapod().geometry;
  const Pose X_WT =
      hexapod.machine.X_WB * make_pose(Mat3(Mat3::Identity()), g.base_joint[2] - g.platform_joint[2]);
  const auto report = check_constraints(
      program_of({hexapod.print_to(X_WT, 0.01, 1), hexapod.print_to(hexapod.X_WT_home, 0.01, 2)}),
      hexapod.machine, 10);
  EXPECT_EQ(report.impossible, (std::vector<std::size_t>{0, 1}));
}

TEST(ConstraintCheck, LinesOnEndWithTheSameViolationAreOneFindingWithTheWorstOfThem) {
  const HexapodForTest hexapod;
  std::vector<toolpath::Step> steps;
  // 55 to 56 mm down is too low; at 10 mm the run is over. Line 70 is the lowest of the first run.
  for (int line = 1; line <= 300; ++line) {
    const double down = line > 100 && line <= 200 ? 0.010 : line == 70 ? 0.056 : 0.055;
    steps.push_back(hexapod.print_to(hexapod.at({0, 0, -down - 1e-6 * (line % 2)}), 0.02, line));
  }
  const auto report = check_constraints(program_of(steps), hexapod.machine);
  const auto found = of_kind(report, LimitKind::strut_length);
  ASSERT_EQ(found.size(), 12u);  // six struts, two runs; the ways to and from 10 mm belong to them
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(found[k].line, 1);
    EXPECT_EQ(found[k].last_line, 101);
    EXPECT_NEAR(found[k].violation.value, strut_below_home(0.056), 1e-9);
    EXPECT_EQ(found[k + 6].line, 201);
    EXPECT_EQ(found[k + 6].last_line, 300);
    EXPECT_NEAR(found[k + 6].violation.value, strut_below_home(0.055001), 1e-9);
  }
}

TEST(ConstraintCheck, MissingFeedIsBadInputNotAFinding) {
  const HexapodForTest hexapod;
  EXPECT_THROW(
      check_constraints(program_of({hexapod.print_to(hexapod.at({0.01, 0, 0}), 0, 3)}), hexapod.machine),
      InputError);
}

}  // namespace
}  // namespace understudy::control

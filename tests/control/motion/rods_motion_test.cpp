// Planned motion of a tool on rods: near the rim its carriages move faster than the tip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "control/motion/constraint_check.h"
#include "control/motion/motion_planner.h"
#include "core/units.h"
#include "machine/description.h"
#include "tests/control/motion/planning_for_test.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {
namespace {

struct DeltaForTest {
  machine::MachineDescription machine = machine::load_machine("delta");
  std::unique_ptr<kinematics::Mechanism> mechanism = machine.make_mechanism();
  MotionLimits limits = motion_limits(machine);
  Pose X_WT_home = machine.X_WB * machine.X_BT_home;

  toolpath::Program program(const std::string& text) const {
    toolpath::GcodeOptions options;
    options.X_WT_home = X_WT_home;
    return toolpath::parse_gcode(text, "p.gcode", options);
  }

  std::vector<PlannedPoint> plan(const std::string& text) const {
    MotionPlanner planner(*mechanism, machine.X_WB, limits, {X_WT_home});
    return stream(planner, program(text).steps);
  }
};

constexpr double kRadius = 0.1344, kRod = 0.267, kJoint = 0.040;  // [m], of the machine's file

/// The tip's y, where it is 5 mm high and x is 0: rod c hangs in that plane. [m]
double y_of(double carriage_c) {
  const double height = carriage_c - 0.005 - kJoint;
  return kRadius - std::sqrt(kRod * kRod - height * height);
}

TEST(RodsMotion, CarriagesKeepTheirVelocityWhereTheyOutrunTheTip) {
  const DeltaForTest printer;
  const auto points = printer.plan("G1 X0 Y60 Z5 F6000\nG1 Y-115 F6000\n");
  const double dt = printer.limits.cycle_time;
  double fastest = 0, at_rim = 0, over_middle = 0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto &from = points[k - 1].setpoint, &to = points[k].setpoint;
    for (std::size_t i = 0; i < 3; ++i)
      fastest = std::max(fastest, std::abs(to.position[i] - from.position[i]) / dt);
    if (to.line != 2) continue;
    const double y = y_of(to.position[2]), tip = std::abs(y - y_of(from.position[2])) / dt;
    if (std::abs(y) < 0.02) over_middle = std::max(over_middle, tip);
    if (std::abs(y + 0.110) < 0.001) at_rim = std::max(at_rim, tip);
    // The towers a and b stand in front, to either side.
    const double dx = kRadius * std::cos(from_deg(30)), dy = y + kRadius / 2;
    ASSERT_NEAR(to.position[0], 0.005 + kJoint + std::sqrt(kRod * kRod - dx * dx - dy * dy), 1e-9);
    ASSERT_NEAR(to.position[1], to.position[0], 1e-9);
  }
  EXPECT_NEAR(over_middle, 0.100, 1e-4);  // the feed
  EXPECT_LE(fastest, 0.100 * 1.001);      // of the drives; a cycle's chord leaves less than a per mille
  EXPECT_GT(fastest, 0.095);
  // 109 mm in front of the middle carriage c moves 243.4 / 109.75 times as far as the tip.
  EXPECT_LE(at_rim, 0.1001 / (0.2434 / 0.10975));
  EXPECT_GT(at_rim, 0.035);
  EXPECT_NEAR(y_of(points.back().setpoint.position[2]), -0.115, 1e-9);
}

TEST(RodsMotion, APlaceOutOfReachIsFoundWithTheRodAndItsSpan) {
  const DeltaForTest printer;
  // Rod c leans by 75 degrees 123.5 mm in front of the middle, and ends at 132.6 mm.
  const auto report = check_constraints(printer.program("G1 X0 Y-100 Z5 F6000\nG1 Y-140\n"), printer.machine);
  std::map<kinematics::LimitKind, ConstraintFinding> found;
  for (const ConstraintFinding& finding : report.findings) found[finding.violation.kind] = finding;
  ASSERT_TRUE(found.contains(kinematics::LimitKind::unreachable));
  const auto& reach = found[kinematics::LimitKind::unreachable];
  EXPECT_EQ(reach.line, 2);
  EXPECT_EQ(reach.violation.part, "rod c");
  EXPECT_EQ(reach.violation.limit, 0.267);
  EXPECT_GT(reach.violation.value, 0.267);
  ASSERT_TRUE(found.contains(kinematics::LimitKind::joint_angle));
  EXPECT_EQ(found[kinematics::LimitKind::joint_angle].line, 2);
  EXPECT_NEAR(found[kinematics::LimitKind::joint_angle].violation.limit, from_deg(75), 1e-12);
  EXPECT_TRUE(check_constraints(printer.program("G1 X0 Y-100 Z5 F1200\nG1 Y-122\n"), printer.machine)
                  .findings.empty());
}

}  // namespace
}  // namespace understudy::control

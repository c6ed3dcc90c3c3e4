// Where an axis is free, the planner turns it before a step needs it: a five-axis table under an upright
// tool.
#include <gmock/gmock.h>

#include <cmath>

#include "control/motion/constraint_check.h"
#include "control/motion/motion_planner.h"
#include "core/error.h"
#include "core/units.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using kinematics::SolveStatus;
using toolpath::Step;
using toolpath::StepKind;

constexpr std::size_t kB = 3, kC = 4;

Step move_to(const Vec3& tip, const Vec3& axis, int line) {
  Step step;
  step.kind = StepKind::move;
  step.X_WT = make_pose(shortest_arc_from_z(axis.normalized()), tip);
  step.feed = 0.010;
  step.line = line;
  return step;
}

class SelfMotion : public ::testing::Test {
 protected:
  SelfMotion()
      : machine_(machine::load_machine("five-axis")),
        mechanism_(machine_.make_mechanism()),
        limits_(motion_limits(machine_)) {}

  std::vector<PlannedPoint> plan(const std::vector<Step>& steps) {
    MotionPlanner planner(*mechanism_, machine_.X_WB, limits_, {machine_.X_WB * machine_.X_BT_home});
    return stream(planner, steps);
  }

  Pose pose_of(const PlannedPoint& point) const {
    Pose X;
    EXPECT_EQ(mechanism_->forward(std::span(point.setpoint.position).first(5), mechanism_->home(), X),
              SolveStatus::ok);
    return X;
  }

  machine::MachineDescription machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  MotionLimits limits_;
};

TEST_F(SelfMotion, TableTurnsBeforeTheToolLeansToAnotherSide) {
  const Vec3 upright(0, 0, 1), at(0.010, 0.004, 0.020);
  const auto points =
      plan({move_to(at, upright, 1), move_to({0.010, 0.008, 0.024}, {0, 0.5, std::sqrt(0.75)}, 2)});
  double turned = 0;
  bool leaned = false;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto &now = points[k].setpoint, &before = points[k - 1].setpoint;
    // No axis moves faster than its drive, with half a percent for the cycle in which a speed changes.
    for (std::size_t i = 0; i < 5; ++i)
      ASSERT_LE(std::abs(now.position[i] - before.position[i]) / limits_.cycle_time,
                1.005 * limits_.axis_velocity[i])
          << "axis " << i << " at " << now.time << " s";
    if (now.line == 2 && std::abs(now.position[kB]) < 1e-9) {
      turned = now.position[kC];
      // The tool rests on its place of the part: rounding of a turn about an axis 50 mm away.
      EXPECT_LE((pose_of(points[k]).translation() - at).norm(), 1e-12);
      EXPECT_EQ(points[k].fraction, 0);
    } else if (now.line == 2) {
      leaned = true;
    }
  }
  EXPECT_TRUE(leaned);
  // Leaning towards y takes C at 90 degrees, or B the other way at -90.
  EXPECT_NEAR(std::abs(turned), from_deg(90), limits_.axis_velocity[kC] * limits_.cycle_time);
  EXPECT_NEAR(std::abs(points.back().setpoint.position[kB]), from_deg(30), 1e-9);
}

TEST_F(SelfMotion, NothingTurnsWhereTheWayGoesOnInThePlaneOfTheTilt) {
  // C stands at 0: to lean towards x needs no turn, and leaning back through upright needs none either.
  const Vec3 at(0.010, 0, 0.020);
  const auto points = plan({move_to(at, {0, 0, 1}, 1), move_to(at, {0.5, 0, std::sqrt(0.75)}, 2),
                            move_to(at, {-0.5, 0, std::sqrt(0.75)}, 3)});
  for (const PlannedPoint& p : points) EXPECT_NEAR(p.setpoint.position[kC], 0, 1e-9) << p.setpoint.time;
  EXPECT_NEAR(points.back().setpoint.position[kB], from_deg(-30), 1e-9);
}

TEST_F(SelfMotion, WayThatGrazesTheUprightPoseIsSlowedToWhatTheTableCanTurn) {
  // The tool leans over from -x to +x and passes upright at a distance: C turns by half a turn on the way,
  // all of it within a few times that distance.
  const Vec3 at(0.010, 0, 0.020);
  for (const double beside_deg : {1.0, 0.3, 0.1, 0.05}) {
    const double beside = std::tan(from_deg(beside_deg));
    const auto points = plan({move_to(at, {-0.2, beside, 1}, 1), move_to(at, {0.2, beside, 1}, 2)});
    for (std::size_t k = 1; k < points.size(); ++k) {
      const auto &now = points[k].setpoint, &before = points[k - 1].setpoint;
      for (std::size_t i = 0; i < 5; ++i)
        ASSERT_LE(std::abs(now.position[i] - before.position[i]) / limits_.cycle_time,
                  1.25 * limits_.axis_velocity[i])
            << beside_deg << " deg beside: axis " << i << " at " << now.time << " s";
    }
  }
}

TEST_F(SelfMotion, WayThatIsTooNearTheUprightPoseIsRefusedByNameAndFoundByTheCheck) {
  const Vec3 at(0.010, 0, 0.020);
  const double beside = std::tan(from_deg(0.01));
  const std::vector<Step> steps{move_to(at, {-0.2, beside, 1}, 1), move_to(at, {0.2, beside, 1}, 2)};
  EXPECT_THAT([&] { plan(steps); },
              ::testing::ThrowsMessage<InputError>(::testing::AllOf(
                  ::testing::HasSubstr("line 2: axis c would leap"), ::testing::HasSubstr("singular"))));
  toolpath::Program program;
  program.steps = steps;
  const auto report = check_constraints(program, machine_);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings.back().violation.kind, kinematics::LimitKind::singularity);
  EXPECT_EQ(report.findings.back().line, 2);
}

}  // namespace
}  // namespace understudy::control

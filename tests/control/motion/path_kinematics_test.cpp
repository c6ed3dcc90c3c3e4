#include "control/motion/path_kinematics.h"

#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::control {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;
using toolpath::Step;

struct Machine {
  explicit Machine(const std::string& name) : description(machine::load_machine(name)) {
    axes_home = axes_at(X_WT_home);
  }
  AxisVector axes_at(const Pose& X_WT) const {
    AxisVector axes{};
    const auto count = static_cast<std::size_t>(mechanism->axis_count());
    EXPECT_EQ(mechanism->inverse(description.X_WB.inverse() * X_WT, {}, std::span(axes).first(count)),
              SolveStatus::ok);
    return axes;
  }
  /// From home, relative to it.
  Step step_to(const Vec3& p, const Vec3& turn, int line = 7) const {
    Step step;
    step.kind = toolpath::StepKind::print;
    step.X_WT = make_pose(Mat3(exp_rotation(turn) * X_WT_home.linear()), X_WT_home.translation() + p);
    step.feed = 0.01;
    step.line = line;
    return step;
  }
  PathSegment segment_to(const Vec3& p, const Vec3& turn) const {
    return path.segment(step_to(p, turn), X_WT_home, axes_home, motion_limits(description));
  }

  machine::MachineDescription description;
  std::unique_ptr<kinematics::Mechanism> mechanism = description.make_mechanism();
  Pose X_WT_home = description.X_WB * mechanism->home();
  PathKinematics path{*mechanism, description.X_WB};
  AxisVector axes_home{};
};

/// Slopes against differences of the positions 1 um of path before and after.
void expect_slopes(const PathKinematics& path, const PathSegment& segment, AxisVector near) {
  const double h = 1e-6;
  const auto axes = static_cast<std::size_t>(path.axis_count());
  for (const double share : {0.1, 0.5, 0.9}) {
    const double s = share * segment.length;
    AxisVector here = near, before = near, after = near;
    ChannelArray slope{};
    ASSERT_EQ(path.evaluate(segment, s, here, slope), SolveStatus::ok);
    before = after = here;
    ASSERT_EQ(path.axes_at(segment, s - h, before), SolveStatus::ok);
    ASSERT_EQ(path.axes_at(segment, s + h, after), SolveStatus::ok);
    for (std::size_t i = 0; i < axes; ++i) {
      const double difference = (after[i] - before[i]) / (2 * h);
      // Rounding of 1e-13 by 2e-6, and 1e-6 for the third derivative.
      EXPECT_NEAR(slope[i], difference, 1e-5 * std::max(1.0, std::abs(difference))) << "axis " << i + 1;
    }
    EXPECT_NEAR(slope[axes], segment.tip_slope().norm(), 1e-12) << "the tip's own speed";
    near = here;
  }
}

TEST(PathKinematics, SlopesAreTheDerivativesOfThePositions) {
  for (const char* name : {"hexapod", "arm"}) {
    const Machine machine(name);
    const PathSegment segment = machine.segment_to({3e-3, -4e-3, 2e-3}, {0.05, -0.08, 0.03});
    SCOPED_TRACE(name);
    expect_slopes(machine.path, segment, machine.axes_home);
  }
}

TEST(PathKinematics, SlopesOfNamedTurnsAreTheDerivativesToo) {
  const Machine machine("five-axis");
  PathSegment segment = machine.segment_to({5e-3, 2e-3, 0}, Vec3::Zero());
  segment.rotary = PathSegment::Rotary{{0.1, 0.2}, {0.4, -0.5}};
  expect_slopes(machine.path, segment, machine.axes_home);
}

TEST(PathKinematics, HalfWayTheTipIsInTheMiddleAndHalfTurned) {
  const Machine machine("hexapod");
  const PathSegment segment = machine.segment_to({4e-3, 0, 0}, {0, 0.1, 0});
  const Pose half = machine.path.pose_at(segment, segment.length / 2);
  const Pose expected = machine.step_to({2e-3, 0, 0}, {0, 0.05, 0}).X_WT;
  EXPECT_TRUE(half.isApprox(expected, 1e-12));
  EXPECT_EQ(machine.path.pose_at(segment, segment.length).matrix(),
            machine.step_to({4e-3, 0, 0}, {0, 0.1, 0}).X_WT.matrix());
}

TEST(PathKinematics, OnlyAxesThatTurnCanLeap) {
  AxisVector from{}, to{};
  to = {0.1, -0.5, 0.3, 0, 0, 0.2};
  EXPECT_EQ(Machine("hexapod").path.largest_turn(from, to).second, 0);  // struts
  EXPECT_EQ(Machine("arm").path.largest_turn(from, to), (std::pair<int, double>{1, 0.5}));
  // x, y, z, b, c
  EXPECT_EQ(Machine("five-axis").path.largest_turn(from, {9, 9, 9, -0.2, 0.1}),
            (std::pair<int, double>{3, 0.2}));
}

TEST(PathKinematics, AReachableWayEndsAtTheAxesOfItsEnd) {
  const Machine machine("hexapod");
  PathSegment segment = machine.segment_to({4e-3, 3e-3, 0}, {0.05, 0, 0});
  AxisVector axes = machine.axes_home;
  machine.path.require_reachable(segment, PoseCheck::limits, axes);
  const AxisVector end = machine.axes_at(segment.X_WT_end);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(axes[i], end[i], 1e-12);
}

TEST(PathKinematics, RefusesAWayByItsLineAndPart) {
  const Machine machine("hexapod");
  const auto refusal = [&](PoseCheck check) -> std::string {
    PathSegment segment = machine.segment_to({0, 0, 0.3}, Vec3::Zero());  // up, to the base
    AxisVector axes = machine.axes_home;
    try {
      machine.path.require_reachable(segment, check, axes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(refusal(PoseCheck::limits),
              testing::AllOf(testing::HasSubstr("line 7: strut"), testing::HasSubstr("shorter than")));
  EXPECT_EQ(refusal(PoseCheck::solvable), "no error") << "struts may have any length there";
}

TEST(PathKinematics, AFreeTableTurnsBeforeTheToolLeansAcrossIt) {
  const Machine machine("five-axis");
  // B turns about y. A lean about x needs C a quarter turn away first; a lean about y needs nothing.
  const PathSegment along = machine.segment_to({1e-3, 0, 0}, {0, 0.3, 0});
  EXPECT_FALSE(machine.path.self_motion_before(along, machine.axes_home));
  const PathSegment across = machine.segment_to({1e-3, 0, 0}, {0.3, 0, 0});
  const auto turn = machine.path.self_motion_before(across, machine.axes_home);
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->length, kTurnRadius * std::numbers::pi / 2, 1e-6);
  EXPECT_EQ(turn->X_WT_begin.matrix(), turn->X_WT_end.matrix());
  EXPECT_NEAR(std::abs(turn->self_motion->to[4] - turn->self_motion->from[4]), std::numbers::pi / 2, 1e-4);
  const Machine hexapod("hexapod");
  const PathSegment lean = hexapod.segment_to(Vec3::Zero(), {0.1, 0, 0});
  EXPECT_FALSE(hexapod.path.self_motion_before(lean, hexapod.axes_home)) << "its axes are never free";
}

TEST(PathKinematics, TurnsOfAStepHaveToMakeItsPose) {
  const Machine five("five-axis"), hexapod("hexapod");
  Step step = five.step_to({1e-3, 0, 0}, {0, 0.2, 0});
  step.rotary = toolpath::RotaryTurns{0.3, 0};
  const auto refusal = [&](const Machine& m) -> std::string {
    try {
      m.path.segment(step, m.X_WT_home, m.axes_home, motion_limits(m.description));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(refusal(five),
              testing::HasSubstr("line 7: the pose is not the one that the rotary words make"));
  EXPECT_THAT(refusal(hexapod), testing::HasSubstr("rotary words on a machine without rotary axes"));
}

}  // namespace
}  // namespace understudy::control

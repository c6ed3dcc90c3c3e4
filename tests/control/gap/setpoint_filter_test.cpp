#include "control/gap/setpoint_filter.h"

#include <gtest/gtest.h>

#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;
using machine::Setpoint;

class Filter : public testing::Test {
 protected:
  /// The tool leans, so that its axis is no axis of W.
  Pose pose() const { return hexapod_.at({2e-3, -1e-3, 1e-3}, {0.05, -0.03, 0}); }
  Pose in_base(const Pose& X_WT) const { return hexapod_.machine.X_WB.inverse() * X_WT; }
  PlannedPoint point(int k) const {
    PlannedPoint p;
    p.X_WT = pose();
    p.setpoint.time = 1e-3 * k;
    p.setpoint.line = k;
    EXPECT_EQ(hexapod_.mechanism->inverse(in_base(p.X_WT), {}, std::span(p.setpoint.position).first(6)),
              SolveStatus::ok);
    return p;
  }
  /// Of the tip along the tool axis, from where the planner had it.
  double shift_of(const Setpoint& s) const {
    Pose X_BT;
    EXPECT_EQ(hexapod_.mechanism->forward(std::span(s.position).first(6), in_base(pose()), X_BT),
              SolveStatus::ok);
    const Vec3 shift = (hexapod_.machine.X_WB * X_BT).translation() - pose().translation();
    EXPECT_NEAR(shift.cross(tool_axis(pose())).norm(), 0, 1e-9);
    return shift.dot(tool_axis(pose()));
  }

  HexapodForTest hexapod_;
  SetpointFilter filter_{hexapod_.machine};
  Setpoint ready_;
};

TEST_F(Filter, SetpointsLeaveOneCycleLaterThanTheyCome) {
  EXPECT_FALSE(filter_.shift(point(1), 0, ready_));
  ASSERT_TRUE(filter_.shift(point(2), 0, ready_));
  EXPECT_EQ(ready_.line, 1);
  EXPECT_EQ(ready_.position, point(1).setpoint.position) << "not shifted, not touched";
  EXPECT_EQ(ready_.velocity, AxisVector{});
  ASSERT_TRUE(filter_.flush(ready_));
  EXPECT_EQ(ready_.line, 2);
  EXPECT_FALSE(filter_.flush(ready_));
}

TEST_F(Filter, TheTipMovesAlongTheToolAxisByTheCorrection) {
  const double corrections[] = {0, 40e-6, -75e-6, 0.3e-3};
  EXPECT_FALSE(filter_.shift(point(0), corrections[0], ready_));
  for (int k = 1; k < 4; ++k) {
    ASSERT_TRUE(filter_.shift(point(k), corrections[k], ready_));
    EXPECT_NEAR(shift_of(ready_), corrections[k - 1], 1e-9) << k;
  }
  ASSERT_TRUE(filter_.flush(ready_));
  EXPECT_NEAR(shift_of(ready_), corrections[3], 1e-9);
  EXPECT_TRUE(filter_.reachable());
}

TEST_F(Filter, AShiftThatGrowsAddsItsOwnVelocity) {
  constexpr double kSpeed = 5e-3;  // [m/s]
  for (int k = 0; k <= 2; ++k) (void)filter_.shift(point(k), kSpeed * 1e-3 * k, ready_);
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(6, 6);
  const AxisVector axes = point(1).setpoint.position;
  ASSERT_EQ(hexapod_.mechanism->axis_rates(in_base(pose()), std::span(axes).first(6), rates),
            SolveStatus::ok);
  Twist rising;
  rising << in_base(pose()).linear().col(2) * kSpeed, Vec3::Zero();
  const Eigen::VectorXd expected = rates * rising;
  ASSERT_EQ(ready_.line, 1);
  for (int i = 0; i < 6; ++i)  // 10 um of way bend a strut's rate by 10 um / 200 mm of it
    EXPECT_NEAR(ready_.velocity[static_cast<std::size_t>(i)], expected[i], 1e-4 * kSpeed)
        << "strut " << i + 1;
}

TEST_F(Filter, ALastSetpointKeepsItsShiftAtRest) {
  (void)filter_.shift(point(1), 10e-6, ready_);
  (void)filter_.shift(point(2), 20e-6, ready_);
  ASSERT_TRUE(filter_.flush(ready_));
  EXPECT_EQ(ready_.velocity, AxisVector{});
  // After a pause of the motion the shift goes on from what stands, not from 0.
  (void)filter_.shift(point(500), 20e-6, ready_);
  (void)filter_.shift(point(501), 20e-6, ready_);
  for (const double v : ready_.velocity) EXPECT_NEAR(v, 0, 1e-9);
}

TEST_F(Filter, WhereTheAxesCannotFollowTheShiftBeforeHolds) {
  (void)filter_.shift(point(1), 50e-6, ready_);
  (void)filter_.shift(point(2), 0.2, ready_);  // up into the base: the struts cannot shorten so far
  EXPECT_FALSE(filter_.reachable());
  ASSERT_FALSE(filter_.violations().empty());
  EXPECT_EQ(filter_.violations().front().kind, kinematics::LimitKind::strut_length);
  ASSERT_TRUE(filter_.flush(ready_));
  EXPECT_NEAR(shift_of(ready_), 50e-6, 1e-9);
  (void)filter_.shift(point(3), 60e-6, ready_);
  EXPECT_TRUE(filter_.reachable());
  EXPECT_TRUE(filter_.violations().empty());
}

TEST_F(Filter, WhatIsDroppedNeverLeaves) {
  (void)filter_.shift(point(1), 50e-6, ready_);
  filter_.drop();
  EXPECT_FALSE(filter_.flush(ready_));
  EXPECT_FALSE(filter_.shift(point(2), 0, ready_));
}

}  // namespace
}  // namespace understudy::control

#include "control/cycle.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "machine/loopback_port.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;
using machine::Status;
using toolpath::StepKind;

class Cycle : public testing::Test {
 protected:
  AxisVector axes_at(const Pose& X_WT) const {
    AxisVector axes{};
    const Pose X_BT = hexapod_.machine.X_WB.inverse() * X_WT;
    EXPECT_EQ(hexapod_.mechanism->inverse(X_BT, {}, std::span(axes).first(6)), SolveStatus::ok);
    return axes;
  }
  machine::LoopbackPort::Options at_home() const {
    machine::LoopbackPort::Options options;
    options.start = axes_at(hexapod_.X_WT_home);
    return options;
  }
  Pose pose_of(const AxisVector& axes) const {
    Pose X_BT;
    EXPECT_EQ(hexapod_.mechanism->forward(std::span(axes).first(6), hexapod_.machine.X_BT_home, X_BT),
              SolveStatus::ok);
    return hexapod_.machine.X_WB * X_BT;
  }
  toolpath::Step to(const Vec3& p, int line, double filament = 0) const {
    return hexapod_.print_to(hexapod_.at(p), 5e-3, line, filament);
  }
  void expect_axes(const AxisVector& axes, const Pose& X_WT) const {
    const AxisVector expected = axes_at(X_WT);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(axes[i], expected[i], 1e-9) << "strut " << i + 1;
  }

  HexapodForTest hexapod_;
  machine::LoopbackPort port_{at_home()};
  ControlCycle cycle_{hexapod_.machine, port_, hexapod_.X_WT_home};
};

TEST_F(Cycle, RestsWhereItWasSentOnceAllIsExecuted) {
  EXPECT_FALSE(cycle_.come_to_rest()) << "nothing was asked for";
  ASSERT_FALSE(cycle_.push(to({5e-3, 0, 2e-3}, 1)));
  ASSERT_FALSE(cycle_.come_to_rest());
  EXPECT_EQ(port_.state().executed, port_.state().accepted);
  EXPECT_FALSE(port_.state().moving);
  expect_axes(port_.state().position, hexapod_.at({5e-3, 0, 2e-3}));
  EXPECT_TRUE(cycle_.resting_pose().isApprox(hexapod_.at({5e-3, 0, 2e-3}), 1e-12));
}

TEST_F(Cycle, SetpointsStandOneCycleApartAndLeaveTimeForTheFirst) {
  ASSERT_EQ(port_.wait_until(3), Status::ok);
  ASSERT_FALSE(cycle_.push(to({5e-3, 0, 0}, 1)));
  ASSERT_FALSE(cycle_.come_to_rest());
  const auto& sent = port_.history();
  ASSERT_GT(sent.size(), 1000u);  // 5 mm at 5 mm/s
  EXPECT_GT(sent.front().time, 3.0 + 1e-2);
  for (std::size_t k = 1; k < sent.size(); ++k) ASSERT_NEAR(sent[k].time - sent[k - 1].time, 1e-3, 1e-9) << k;
  for (const double v : sent.back().velocity) EXPECT_EQ(v, 0);
}

TEST_F(Cycle, FilamentCountsOnFromOneStretchToTheNext) {
  for (const int line : {1, 2}) {
    ASSERT_FALSE(cycle_.push(to({line * 1e-3, 0, 0}, line, 1e-4)));
    ASSERT_FALSE(cycle_.come_to_rest());
    EXPECT_NEAR(port_.history().back().filament, line * 1e-4, 1e-12);
  }
}

TEST_F(Cycle, AStepOutOfReachLeavesTheMotionAsItWas) {
  ASSERT_FALSE(cycle_.push(to({2e-3, 0, 0}, 1)));
  try {
    (void)cycle_.push(to({0, 0, 1}, 7));
    FAIL() << "a metre up is out of reach";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("line 7"));
  }
  ASSERT_FALSE(cycle_.come_to_rest());
  expect_axes(port_.state().position, hexapod_.at({2e-3, 0, 0}));
}

TEST_F(Cycle, AnAbandonedStretchGoesOnFromWhereTheToolRests) {
  for (int line = 1; line <= 30; ++line)  // to and fro along x: more than the lookahead holds
    ASSERT_FALSE(cycle_.push(to({line % 2 == 0 ? 0.0 : 10e-3, 0, 0}, line)));
  Vec3 braking;
  do {  // in the middle of a line, where the speed is the programmed one
    ASSERT_EQ(port_.wait_until(port_.now() + 0.01), Status::ok);
    braking = pose_of(port_.state().position).translation();
  } while (std::abs(braking.x() - 5e-3) > 1e-3);
  const Stop stop = cycle_.abandon(0.9e-4);
  ASSERT_FALSE(stop) << stop.why;
  EXPECT_FALSE(port_.state().moving);
  const Pose rest = cycle_.resting_pose();
  EXPECT_TRUE(rest.isApprox(pose_of(port_.state().position), 1e-9));
  // Along the path, and by half of what 5 mm/s make in the braking time.
  const Vec3 way = rest.translation() - braking;
  EXPECT_NEAR(std::abs(way.x()), 5e-3 * machine::kBrakingTime / 2, 10e-6);
  EXPECT_NEAR(way.tail<2>().norm(), 0, 1e-8);

  const std::size_t before = port_.history().size();
  ASSERT_FALSE(cycle_.push(to({0, 0, 3e-3}, 31, 1e-4)));
  ASSERT_FALSE(cycle_.come_to_rest());
  const AxisVector resting = axes_at(rest);
  for (std::size_t i = 0; i < 6; ++i)  // 2 m/s^2 over the first cycle: 1 um
    EXPECT_NEAR(port_.history()[before].position[i], resting[i], 2e-6) << "the first setpoint leaps";
  EXPECT_NEAR(port_.history().back().filament, 1.9e-4, 1e-12);
  expect_axes(port_.state().position, hexapod_.at({0, 0, 3e-3}));
}

TEST_F(Cycle, TheNextStretchBeginsOffThePoseByWhatTheRestWasShifted) {
  ASSERT_FALSE(cycle_.push(to({2e-3, 0, 0}, 1)));
  ASSERT_FALSE(cycle_.come_to_rest());
  cycle_.shift_rest({0, 0, 1e-4});
  EXPECT_TRUE(cycle_.resting_pose().isApprox(hexapod_.at({2e-3, 0, 1e-4}), 1e-12));
}

TEST_F(Cycle, AFaultStopsItAndSaysWhich) {
  port_.inject_fault(machine::Fault::emergency_stop, 0.3);
  ASSERT_FALSE(cycle_.push(to({5e-3, 0, 0}, 1)));
  const Stop stop = cycle_.come_to_rest();
  EXPECT_EQ(stop.status, Status::faulted);
  EXPECT_EQ(stop.fault, machine::Fault::emergency_stop);
  EXPECT_NEAR(stop.time, 0.3, 1e-9);
  EXPECT_EQ(cycle_.push(to({6e-3, 0, 0}, 2)).status, Status::ok) << "one step is less than a batch";
  EXPECT_EQ(cycle_.come_to_rest().status, Status::faulted);
}

}  // namespace
}  // namespace understudy::control

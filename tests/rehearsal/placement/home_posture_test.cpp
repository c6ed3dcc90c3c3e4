#include "rehearsal/placement/home_posture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "kinematics/chain/arm.h"

namespace understudy::rehearsal {
namespace {

using machine::load_machine;
using testing::HasSubstr;
using testing::ThrowsMessage;

// The closed form of the arm knows all eight; of these count the ones within the ranges, home left out.
TEST(HomePosture, TheOthersAreThoseOfTheClosedForm) {
  const auto arm = load_machine("arm");
  const auto& chain = arm.chain().kinematics;
  std::array<kinematics::ArmSolution, kinematics::kArmBranches> solutions;
  const int count =
      kinematics::arm_branches(kinematics::arm_geometry(chain.parameters), arm.X_BT_home, solutions);
  int within = 0;
  for (int k = 0; k < count; ++k) {
    bool fits = true;
    for (std::size_t i = 0; i < 6; ++i) {
      const double q = solutions[static_cast<std::size_t>(k)].axes[i];
      fits = fits && q >= chain.chain.axes[i].lower && q <= chain.chain.axes[i].upper;
    }
    within += fits;
  }
  EXPECT_GT(within, 1) << "or this test says nothing";
  const auto others = other_home_postures(arm);
  EXPECT_EQ(static_cast<int>(others.size()), within - 1);
  for (const auto& home : others) {
    auto standing = arm;
    stand_at_home(home, standing);
    EXPECT_TRUE(standing.X_BT_home.isApprox(arm.X_BT_home, 1e-9));
    EXPECT_TRUE(standing.make_mechanism()->home().isApprox(arm.X_BT_home, 1e-9));
  }
}

TEST(HomePosture, MachinesWithOneWayHaveNoOthers) {
  for (const char* name : {"hexapod", "five-axis", "corexy"})
    EXPECT_TRUE(other_home_postures(load_machine(name)).empty());
}

TEST(HomePosture, WhatIsNoPostureIsRefused) {
  auto arm = load_machine("arm"), hexapod = load_machine("hexapod");
  EXPECT_THAT(
      [&] {
        stand_at_home({1, 2}, arm);
      },
      ThrowsMessage<InputError>(HasSubstr("2 numbers for the 6 axes")));
  EXPECT_THAT(
      [&] {
        stand_at_home({0, 500, 0, 0, 50, 0}, arm);
      },
      ThrowsMessage<InputError>(HasSubstr("j2 is 500 deg, not within -45..150")));
  EXPECT_THROW(stand_at_home({1, 2, 3, 4, 5, 6}, hexapod), InputError);
}

}  // namespace
}  // namespace understudy::rehearsal

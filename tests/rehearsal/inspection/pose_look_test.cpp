// One pose looked at, on machines whose answer is known by hand.
#include "rehearsal/inspection/pose_look.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using kinematics::SolveStatus;

const machine::MachineDescription& five_axis() {
  static const machine::MachineDescription machine = machine::load_machine("five-axis");
  return machine;
}

// By hand, with the tilting axis 30 mm below the table: the slides of a tip at (10, 0, 20) and B 90.
TEST(PoseLook, RotaryWordsStandWhereTheySay) {
  const PoseLook look = look_at_words(five_axis(), "X10 Y0 Z20 B90 C0", nullptr);
  ASSERT_EQ(look.status, SolveStatus::ok);
  EXPECT_NEAR(to_mm(look.axes[0]), -50, 1e-9);
  EXPECT_NEAR(to_mm(look.axes[2]), -20, 1e-9);
  EXPECT_NEAR(to_deg(look.axes[3]), 90, 1e-9);
  EXPECT_NEAR(tool_axis(look.X_WT).x(), 1, 1e-12);
}

// Of a tilted tool the table has two: (B, C), and (-B, C + 180 degrees).
TEST(PoseLook, TheOtherBranchIsFound) {
  const PoseLook look = look_at_words(five_axis(), "X10 Y0 Z40 B20 C30", nullptr);
  ASSERT_EQ(look.others.size(), 1u);
  EXPECT_NEAR(to_deg(look.others[0][3]), -20, 1e-6);
  EXPECT_NEAR(std::abs(std::remainder(look.others[0][4] - from_deg(210), 2 * std::numbers::pi)), 0, 1e-6);
  EXPECT_LT(look.condition, 1e3);
  EXPECT_TRUE(look.good());
}

TEST(PoseLook, AnUprightToolIsSingularThere) {
  const PoseLook look = look_at_words(five_axis(), "X10 Z40 I0 J0 K1", nullptr);
  EXPECT_EQ(look.condition, kinematics::kSingularCondition);
}

// The tip on the line of B, where the slides stay.
TEST(PoseLook, ALimitThatIsBrokenIsNamed) {
  const PoseLook look = look_at_words(five_axis(), "X0 Z-30 B130", nullptr);
  ASSERT_FALSE(look.broken.empty());
  EXPECT_EQ(look.broken[0].part, "axis b");
  EXPECT_FALSE(look.good());
}

// The carriage's box of 60 mm hangs 40 mm above the tip: by hand it is that far above the table, less the
// tip's height below it.
TEST(PoseLook, WhatIsNearIsMeasured) {
  const PoseLook look = look_at_words(five_axis(), "X0 Y0 Z5", nullptr);
  ASSERT_TRUE(look.nozzle && look.nearest);
  EXPECT_NEAR(to_mm(look.nozzle->distance), 5, 1e-6);
  EXPECT_NEAR(to_mm(look.nearest->distance), 5 + 9 - 3, 1.1) << "a duct that begins 9 mm up, 3 mm thick";
  const PoseLook below = look_at_words(five_axis(), "X0 Y0 Z-2", nullptr);
  EXPECT_LT(below.nozzle->distance, 0);
  EXPECT_FALSE(below.good());
}

TEST(PoseLook, AxesMakeThePose) {
  const PoseLook look = look_at_axes(five_axis(), {-0.05, 0, -0.02, std::numbers::pi / 2, 0}, nullptr);
  EXPECT_LT((1e3 * look.X_WT.translation() - Vec3(10, 0, 20)).norm(), 1e-9);
  EXPECT_THROW(look_at_axes(five_axis(), {NAN}, nullptr), InputError);
}

TEST(PoseLook, HomeIsAskedForByNoWords) {
  for (const char* name : {"hexapod", "arm", "five-axis"}) {
    const auto machine = machine::load_machine(name);
    const PoseLook look = look_at_words(machine, "", nullptr);
    EXPECT_LT((look.X_WT.matrix() - (machine.X_WB * machine.X_BT_home).matrix()).norm(), 1e-12) << name;
    EXPECT_TRUE(look.good()) << name;
  }
  EXPECT_THROW(look_at_words(five_axis(), "Q5", nullptr), InputError);
}

TEST(PoseLook, WhatCannotBeReachedSaysSo) {
  const PoseLook look = look_at_words(machine::load_machine("arm"), "X5000", nullptr);
  EXPECT_EQ(look.status, SolveStatus::unreachable);
  EXPECT_FALSE(look.broken.empty());
  EXPECT_FALSE(look.good());
}

}  // namespace
}  // namespace understudy::rehearsal

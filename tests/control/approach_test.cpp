#include "control/approach.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using toolpath::Program;
using toolpath::Step;
using toolpath::StepKind;

TEST(Approach, IsTheStraightWayDownToABead) {
  const Program program = bead_program();
  for (std::size_t i = 0; i < program.steps.size(); ++i)
    EXPECT_EQ(is_approach(program, i), i == 4) << "step " << i;
}

TEST(Approach, IsShortStraightUnturnedAndBeforeABead) {
  const double z = kTable + kGap;
  const auto changed = [](std::size_t index, auto change) {
    Program program = bead_program();
    change(program.steps[index]);
    return is_approach(program, 4);
  };
  EXPECT_TRUE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z + 9.9e-3; }));
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z + 10.1e-3; })) << "longer than 10 mm";
  EXPECT_TRUE(changed(3, [&](Step& s) { s.X_WT.translation().x() = 2e-3 * std::tan(from_deg(0.9)); }));
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().x() = 2e-3 * std::tan(from_deg(1.1)); }))
      << "askew";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.linear() = exp_rotation(Vec3(from_deg(2), 0, 0)); }))
      << "turning";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z - 2e-3; })) << "upwards";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z; })) << "no way at all";
  EXPECT_FALSE(changed(4, [&](Step& s) { s.kind = StepKind::travel; })) << "a travel";
  EXPECT_FALSE(changed(5, [&](Step& s) { s.kind = StepKind::travel; })) << "no bead begins there";
}

TEST(Approach, BeginsWhereTheLastStepThatMovedEnded) {
  const Program program = bead_program();
  const Pose start = make_pose(Quat::Identity(), Vec3(1, 2, 3));
  EXPECT_EQ(pose_before(program, 0, start).matrix(), start.matrix());
  EXPECT_EQ(pose_before(program, 2, start).matrix(), start.matrix()) << "heat and fan move nothing";
  EXPECT_EQ(pose_before(program, 4, start).matrix(), program.steps[3].X_WT.matrix());
}

}  // namespace
}  // namespace understudy::control

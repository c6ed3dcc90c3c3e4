#include "control/registration/moved_program.h"

#include <gtest/gtest.h>

#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using toolpath::Program;
using toolpath::Step;
using toolpath::StepKind;

/// A quarter turn about z, and a shift: (1, 0, 0) goes to (10, 1, 0) mm.
Pose quarter() { return make_pose(exp_rotation(Vec3(0, 0, std::numbers::pi / 2)), Vec3(10e-3, 0, 0)); }

TEST(MovedProgram, EveryPoseGoesWithThePart) {
  const Program moved = moved_program(bead_program(), quarter());
  const Step& print = moved.steps[5];  // 5 mm along x, the tool upright
  ASSERT_EQ(print.kind, StepKind::print);
  EXPECT_LT((print.X_WT.translation() - Vec3(10e-3, 5e-3, kTable + kGap)).norm(), 1e-12);
  EXPECT_LT((print.X_WT.linear().col(0) - Vec3::UnitY()).norm(), 1e-12) << "the tool turns with it";
  EXPECT_EQ(print.filament, bead_program().steps[5].filament);
  EXPECT_EQ(print.line, 6);
}

TEST(MovedProgram, HomeStaysAndSoDoesWhatHappensThere) {
  Program program = bead_program();
  Step home = program.steps[2], dwell = program.steps[2];
  home.kind = StepKind::home;
  dwell.kind = StepKind::dwell;
  program.steps.insert(program.steps.end() - 1, {home, dwell});
  const Program moved = moved_program(program, quarter());
  const std::size_t at = moved.steps.size() - 3;
  EXPECT_EQ(moved.steps[at].X_WT.matrix(), home.X_WT.matrix());
  EXPECT_EQ(moved.steps[at + 1].X_WT.matrix(), home.X_WT.matrix());
  EXPECT_EQ(moved.steps[0].X_WT.matrix(), program.steps[0].X_WT.matrix()) << "before anything moves";
}

TEST(MovedProgram, AStepThatNamesItsTurningAxesKeepsThem) {
  Program program = bead_program();
  program.steps[5].rotary = toolpath::RotaryTurns{0.1, 0.2};
  const Program moved = moved_program(program, quarter());
  EXPECT_EQ(moved.steps[5].X_WT.linear(), program.steps[5].X_WT.linear());
  EXPECT_NEAR(moved.steps[5].X_WT.translation().y(), 5e-3, 1e-12);
}

}  // namespace
}  // namespace understudy::control

#include "toolpath/program_builder.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

const Pose kA = tool_at(Vec3(0.01, 0, 0.02), Vec3::UnitZ()), kB = tool_at(Vec3(0.03, 0, 0.02), Vec3::UnitZ());

TEST(ProgramBuilder, BeginsWithHeaterAndFanWhereTheToolWillStart) {
  ProgramBuilder builder(1.75e-3);
  builder.begin(kA, 483.15, 0.5);
  const Program program = builder.take();
  ASSERT_EQ(program.steps.size(), 2u);
  EXPECT_EQ(program.steps[0].kind, StepKind::temperature);
  EXPECT_EQ(program.steps[0].temperature, 483.15);
  EXPECT_TRUE(program.steps[0].wait);
  EXPECT_EQ(program.steps[1].kind, StepKind::fan);
  EXPECT_EQ(program.steps[1].fan, 0.5);
  for (const Step& s : program.steps) EXPECT_TRUE(s.X_WT.isApprox(kA));
}

TEST(ProgramBuilder, ZeroKelvinLeavesTheHeaterAlone) {
  ProgramBuilder builder(1.75e-3);
  builder.begin(kA, 0, 1);
  EXPECT_EQ(builder.take().steps.size(), 1u);
}

TEST(ProgramBuilder, FilamentIsTheVolumeOverTheFilamentsSection) {
  ProgramBuilder builder(2e-3);
  builder.print(kB, 5e-3, 7e-9);
  const Step step = builder.take().steps.front();
  EXPECT_EQ(step.kind, StepKind::print);
  EXPECT_EQ(step.feed, 5e-3);
  EXPECT_DOUBLE_EQ(step.filament, 7e-9 / (std::numbers::pi * 1e-6));
}

TEST(ProgramBuilder, ADwellStaysWhereTheToolIsAndNoTimeIsNoStep) {
  ProgramBuilder builder(1.75e-3);
  EXPECT_TRUE(builder.empty());
  builder.travel(kA);
  builder.move(kB, 1e-3);
  builder.dwell(0);
  builder.dwell(3);
  EXPECT_TRUE(builder.tool().isApprox(kB));
  const Program program = builder.take();
  ASSERT_EQ(program.steps.size(), 3u);
  EXPECT_EQ(program.steps[2].kind, StepKind::dwell);
  EXPECT_EQ(program.steps[2].duration, 3);
  EXPECT_TRUE(program.steps[2].X_WT.isApprox(kB));
}

TEST(ProgramBuilder, ToolStandsOffAlongItsAxisWithoutSpin) {
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  const Pose X_WT = tool_at(Vec3(0.1, 0.2, 0.3), axis, 0.05);
  EXPECT_LE((tool_axis(X_WT) - axis).norm(), 1e-14);
  EXPECT_LE((X_WT.translation() - Vec3(0.1, 0.2, 0.3) - 0.05 * axis).norm(), 1e-15);
  EXPECT_NEAR(log_rotation(X_WT.linear()).dot(axis), 0, 1e-14) << "the shortest turn from upright";
}

}  // namespace
}  // namespace understudy::toolpath

#include "rehearsal/placement/path_poses.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;
using toolpath::StepKind;

PathPose at(double x, double y, double z = 0) {
  return {make_pose(Quat::Identity(), Vec3(x, y, z)), std::nullopt, 0, true};
}

toolpath::Step step(StepKind kind, const Vec3& p, int line) {
  toolpath::Step s;
  s.kind = kind;
  s.X_WT.translation() = p;
  s.line = line;
  return s;
}

TEST(PathPoses, HomeAndWhatIsLeftToItStayBehind) {
  const auto read_for = [](const Vec3& home) {
    toolpath::Program program;
    program.steps = {step(StepKind::home, home, 1),
                     step(StepKind::travel, {home.x(), home.y(), 0.1}, 2),  // Z alone
                     step(StepKind::travel, {0.3, 0.02, 0.1}, 3),           // X as at home, but said
                     step(StepKind::print, {0.05, 0.02, 0.1}, 4),
                     step(StepKind::home, home, 5),
                     step(StepKind::travel, {0.01, 0.06, 0.2}, 6)};
    return program;
  };
  toolpath::Program program = read_for({0.3, 0.4, 0.5}), other = read_for({0.31, 0.42, 0.53});
  const ProgramPath path = program_path(program, other);
  ASSERT_EQ(path.poses.size(), 3u);
  EXPECT_THAT(path.connected, ElementsAre(false, true, false));
  EXPECT_TRUE(path.poses[0].prints) << "a bead begins here";
  EXPECT_FALSE(path.poses[2].prints);
  EXPECT_TRUE(path.middle().isApprox(Vec2(0.175, 0.02), 1e-12));
  EXPECT_EQ(path.lowest, 0.1);
  for (toolpath::Program* p : {&program, &other}) p->steps.erase(p->steps.begin() + 3);
  EXPECT_THROW(program_path(program, other), InputError) << "prints nothing";
}

TEST(PathPoses, TheMiddleOfThePrintGoesToTheStand) {
  ProgramPath path;
  path.lower = Vec2(0.1, 0.2);
  path.upper = Vec2(0.3, 0.2);
  path.height = 0.004;
  const Stand stand{{0.5, -0.5}, 1.234, 0.4};
  const PathPose middle = path.placed(at(0.2, 0.2), stand);
  EXPECT_TRUE(middle.X_WT.translation().isApprox(Vec3(0.5, -0.5, 0.004), 1e-12));
  const PathPose end = path.placed(at(0.3, 0.2), stand);
  const Vec3 arm = end.X_WT.translation() - middle.X_WT.translation();
  EXPECT_NEAR(std::atan2(arm.y(), arm.x()), 1.234, 1e-12);
}

TEST(PathPoses, SpreadPosesHaveTheOutermostAndNoNeighbours) {
  std::vector<PathPose> poses;
  for (int i = 0; i <= 1000; ++i) poses.push_back(at(1e-4 * i, 0));
  const auto chosen = spread_poses(poses, 11);
  EXPECT_EQ(chosen.size(), 11u);
  EXPECT_THAT(chosen, IsSupersetOf({std::size_t{0}, std::size_t{1000}}));
  // Eleven on a line, each time halfway between those before: nowhere nearer than a sixteenth.
  for (std::size_t k = 1; k < chosen.size(); ++k) EXPECT_GE(chosen[k] - chosen[k - 1], 62u);
  EXPECT_EQ(spread_poses({at(1, 1), at(1, 1)}, 10).size(), 1u) << "equal poses count once";
}

TEST(PathPoses, TheHullHoldsEveryPrintedPose) {
  std::vector<PathPose> poses{at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
  Random random(3, "hull");
  for (int i = 0; i < 500; ++i) poses.push_back(at(random.uniform(-0.99, 0.99), random.uniform(-0.99, 0.99)));
  poses.push_back(at(5, 5));
  poses.back().prints = false;
  EXPECT_THAT(printed_hull(poses), ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace understudy::rehearsal

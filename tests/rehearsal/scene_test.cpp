#include "rehearsal/scene.h"

#include <gtest/gtest.h>

#include "machine/description.h"

namespace understudy::rehearsal {
namespace {

toolpath::Step step(toolpath::StepKind kind, double x) {
  toolpath::Step s;
  s.kind = kind;
  s.line = 1;
  s.X_WT.translation() = Vec3(x, 0, 0);
  return s;
}

TEST(PrintedPath, IsOnePolylineBetweenTwoTravels) {
  using toolpath::StepKind;
  toolpath::Program program;
  program.steps = {step(StepKind::travel, 1), step(StepKind::print, 2),  step(StepKind::print, 3),
                   step(StepKind::travel, 4), step(StepKind::travel, 5), step(StepKind::print, 6)};
  const auto path = printed_path(program);
  ASSERT_EQ(path.size(), 2u);
  ASSERT_EQ(path[0].size(), 3u);
  EXPECT_EQ(path[0].front().x(), 1) << "from where the travel ended";
  EXPECT_EQ(path[0].back().x(), 3);
  ASSERT_EQ(path[1].size(), 2u);
  EXPECT_EQ(path[1].front().x(), 5);
  const auto begun = printed_path(program, 0, 2);
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_EQ(begun[0], path[0]);
}

TEST(MachineScene, HoldsToolStrutsAndTheJointsTheyHangFrom) {
  const auto machine = machine::load_machine("hexapod");
  const auto as_built = sim::make_as_built(machine, "nominal", 1);
  const Pose home = machine.X_WB * machine.X_BT_home;
  const Scene scene = machine_scene(machine, as_built, {home, {}});
  int struts = 0, joints = 0;
  for (const auto& body : scene.bodies) {
    struts += body.name.starts_with("strut");
    joints += body.name == "base joint";
  }
  EXPECT_EQ(struts, 6);
  EXPECT_EQ(joints, 6);
  EXPECT_FALSE(scene.simulated);
  EXPECT_TRUE(scene.X_WT.isApprox(home));
}

}  // namespace
}  // namespace understudy::rehearsal

// Whether the dot beside the nozzle shows what is printed on, on small programs of straight beads.
#include "control/gap/deposited_bead_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using testing::ElementsAre;
using toolpath::StepKind;

constexpr double kWidth = 0.48e-3;  // [m]
constexpr double kDotRadius = 0.075e-3;

/// Filament for a bead of kWidth and of the aimed gap's height.
double filament_for(double length) {
  const double d = hexapod().tool.filament_diameter;
  return length * kWidth * hexapod().gap.aim / (M_PI / 4 * d * d);
}

/// A bead of 10 mm along x at y = 0, another one beside it, then one on top of the first.
toolpath::Program three_beads() {
  const double h = hexapod().gap.aim, f = filament_for(10e-3);
  toolpath::Program program;
  program.steps = {step_to(StepKind::travel, {0, 0, h}, 5e-3, 1),
                   step_to(StepKind::print, {10e-3, 0, h}, 5e-3, 2, f),
                   step_to(StepKind::travel, {0, kWidth, h}, 5e-3, 3),
                   step_to(StepKind::print, {10e-3, kWidth, h}, 5e-3, 4, f),
                   step_to(StepKind::travel, {0, 0, 2 * h}, 5e-3, 5),
                   step_to(StepKind::print, {10e-3, 0, 2 * h}, 5e-3, 6, f)};
  return program;
}

DepositedBeadMap::Place ground(double x, double y, double height) {
  return {{x, y, 0}, Vec3::UnitZ(), height};
}

TEST(DepositedBeadMap, CountsABeadAsFarAsItIsLaid) {
  const DepositedBeadMap laid(three_beads(), hexapod());
  const double h = hexapod().gap.aim;
  const auto shows = [&](double x, double tip_x) {
    return laid.shows_ground(ground(x, 0, h), kDotRadius, 2, {tip_x, 0, h});
  };
  EXPECT_TRUE(shows(5e-3, 3e-3));   // ahead
  EXPECT_FALSE(shows(5e-3, 8e-3));  // behind
  EXPECT_TRUE(laid.shows_ground(ground(5e-3, 0, h), kDotRadius, 1, {0, 0, h}));
}

TEST(DepositedBeadMap, ADotBesideABeadIsClearByItsRadiusAndATenthOfAMillimetre) {
  const DepositedBeadMap laid(three_beads(), hexapod());
  const double h = hexapod().gap.aim, clear = kWidth / 2 + kDotRadius + 0.1e-3;
  const auto shows = [&](double y) {
    return laid.shows_ground(ground(5e-3, y, h), kDotRadius, 3, {5e-3, 2e-3, h});
  };
  EXPECT_FALSE(shows(clear - 1e-6));
  EXPECT_TRUE(shows(clear + 1e-6));
  EXPECT_FALSE(shows(-clear + 1e-6));
  EXPECT_TRUE(shows(-clear - 1e-6));
}

TEST(DepositedBeadMap, AboveTheFirstLayerTheDotMustLieOnTheLayerBelow) {
  const DepositedBeadMap laid(three_beads(), hexapod());
  const double h = hexapod().gap.aim;
  const auto shows = [&](double y) {
    return laid.shows_ground(ground(9e-3, y, 2 * h), kDotRadius, 6, {5e-3, 0, 2 * h});
  };
  EXPECT_TRUE(shows(0));  // ahead of the tip
  EXPECT_TRUE(shows(kWidth));
  EXPECT_FALSE(shows(2e-3)) << "the table shines through";
  EXPECT_FALSE(laid.shows_ground(ground(3e-3, 0, 2 * h), kDotRadius, 6, {5e-3, 0, 2 * h}));  // behind
}

TEST(DepositedBeadMap, FollowsATiltedSurface) {
  const Mat3 R = exp_rotation(Vec3(0.3, -0.2, 0.1));
  toolpath::Program program = three_beads();
  for (auto& step : program.steps) step.X_WT = Pose(R * step.X_WT);
  const DepositedBeadMap laid(program, hexapod());
  const double h = hexapod().gap.aim;
  const auto shows = [&](double y) {
    return laid.shows_ground({R * Vec3(5e-3, y, 0), R * Vec3::UnitZ(), h}, kDotRadius, 3,
                             R * Vec3(5e-3, 2e-3, h));
  };
  EXPECT_FALSE(shows(0.2e-3));
  EXPECT_TRUE(shows(0.6e-3));
}

PrintOptions controlled(GapControl mode) {
  PrintOptions options;
  options.gap_control = mode;
  return options;
}

GapRigOptions flat_rig() {
  return {plane_through(Vec3(0, 0, kTable), Vec3::UnitZ()), Vec3::Zero(), Vec3::Zero()};
}

TEST(ContinuousPrint, ADotThatTrailsOnItsOwnBeadIsNotLookedAt) {
  // The dot is 1.1 mm beside the tip towards +y: on the way towards -y it runs over what was just laid.
  GapRig rig(hexapod(), flat_rig());
  rig.set_frame_fault([&](const Pose& X, Image& image) {
    if (X.translation().y() > -1.5e-3 || X.translation().x() < 5.7e-3) return true;
    Pose over_bead = rig.truth(X);
    over_bead.translation().z() -= kGap;
    rig.draw_spot(*exact_dot(hexapod(), flat_rig().world, over_bead), 190, image);
    return true;
  });
  const double z = kTable + kGap, f = filament_for(6e-3);
  toolpath::Program program;
  program.steps = {step_to(StepKind::travel, {0, 0, z + 2e-3}, 0, 1),
                   step_to(StepKind::move, {0, 0, z}, 2e-3, 2),
                   step_to(StepKind::print, {6e-3, 0, z}, 5e-3, 3, f),
                   step_to(StepKind::print, {6e-3, -8e-3, z}, 5e-3, 4, f),
                   step_to(StepKind::print, {0, -8e-3, z}, 5e-3, 5, f),
                   step_to(StepKind::move, {0, -8e-3, z + 5e-3}, 5e-3, 6)};
  const PrintResult result = print(program, hexapod(), rig.port(), controlled(GapControl::continuous));
  EXPECT_TRUE(result.completed) << result.stop.why;
  ASSERT_TRUE(result.following);
  EXPECT_GT(result.following->used, 30);  // 1.2 s along x at 40 frames a second
}

TEST(Print, AnApproachWhoseDotWouldLieOnABeadKeepsTheOffsetAndIsTold) {
  GapRig rig(hexapod(), {flat_rig().world, Vec3(0, 0, 0.1e-3), Vec3::Zero()});
  const double z = kTable + kGap, f = filament_for(4e-3);
  toolpath::Program program;
  program.steps = {step_to(StepKind::travel, {0, 0, z + 2e-3}, 0, 1),
                   step_to(StepKind::move, {0, 0, z}, 2e-3, 2),
                   step_to(StepKind::print, {4e-3, 0, z}, 5e-3, 3, f),
                   step_to(StepKind::travel, {4e-3, 0, z + 2e-3}, 0, 4),
                   step_to(StepKind::travel, {2e-3, -1.0e-3, z + 2e-3}, 0, 5),
                   step_to(StepKind::move, {2e-3, -1.0e-3, z}, 2e-3,
                           6),  // its dot: (2, 0), 0.1 mm beside the bead's middle
                   step_to(StepKind::print, {4e-3, -1.0e-3, z}, 5e-3, 7, f),
                   step_to(StepKind::move, {4e-3, -1.0e-3, z + 2e-3}, 5e-3, 8)};
  const PrintResult result = print(program, hexapod(), rig.port(), controlled(GapControl::start));
  ASSERT_TRUE(result.completed) << result.stop.why;
  EXPECT_EQ(result.approaches.size(), 1u);
  EXPECT_THAT(result.unmeasured_starts, ElementsAre(6));
  for (const auto& s : rig.port().history())
    if (s.line == 7) {
      ASSERT_NEAR(rig.gap_at(rig.commanded(s.position)), kGap, 25e-6);
    }
}

}  // namespace
}  // namespace understudy::control

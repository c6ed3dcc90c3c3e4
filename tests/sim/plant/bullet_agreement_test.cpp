// Two engines and one set of motions: docs/engine-agreement.md.
#include <gtest/gtest.h>

#include <cstdlib>

#include "bench/plant/engine_comparison.h"

namespace understudy::sim {
namespace {

constexpr double kGoal = 5e-6;              // [m], of the peak tip errors of MuJoCo and Bullet
constexpr double kQuasistaticGoal = 10e-6;  // [m]
constexpr double kFollowed = 0.5e-6;        // [m], half of the time at least

TEST(EngineAgreement, MujocoAndBulletMoveTheTipAlike) {
  // Half a second of a motion that no strut leaves its stop in: nothing but the stops' softness may differ,
  // 0.4 um at 0.5 ms.
  const auto machine = machine::load_machine("hexapod");
  auto motion = zigzag(machine, 1);
  motion.duration = 0.5;
  const auto row = compare_engines(machine, motion, 100e-6, 0.5e-3);
  EXPECT_LE(row.bullet_difference.largest, 1e-6);
  EXPECT_EQ(row.mujoco.flips, row.bullet.flips);
  EXPECT_GT(row.mujoco.peak_error, 50e-6);  // the play is there
}

void expect_agreement(const machine::MachineDescription& machine, const ReferenceMotion& motion, double play,
                      int flip_spread = 0) {
  SCOPED_TRACE(testing::Message() << motion.name << ", play " << play);
  const auto row = compare_engines(machine, motion, play, 0.1e-3);
  EXPECT_LE(row.bullet_difference.peak_error, kGoal);
  EXPECT_LE(std::abs(row.mujoco.flips - row.bullet.flips), flip_spread);
  EXPECT_LE(row.quasistatic_difference.peak_error, kQuasistaticGoal);
  // A motion in which struts are always on their way through their play has no such half.
  if (row.mujoco.flips < 10) {
    EXPECT_LE(row.bullet_difference.median, kFollowed);
  }
}

class SlowEngineAgreement : public testing::TestWithParam<double> {};

TEST_P(SlowEngineAgreement, HoldsOnTheHexapod) {
  const auto machine = machine::load_machine("hexapod");
  for (const auto& motion : {circle_at_15_degrees(machine), tilt_sweep(machine), zigzag(machine, 1)})
    expect_agreement(machine, motion, GetParam());
  // Goal missed at 200 um, where struts rattle all the time: each engine then differs by as many flips from
  // itself at another timestep (MuJoCo 48, 50, 46 and Bullet 50, 44, 44 at 0.2, 0.1, 0.05 ms).
  expect_agreement(machine, zigzag(machine, 3), GetParam(), GetParam() > 150e-6 ? 6 : 0);
}

TEST_P(SlowEngineAgreement, HoldsOnTheArm) {
  const auto machine = machine::load_machine("arm");
  expect_agreement(machine, arm_path(machine), GetParam());
}

INSTANTIATE_TEST_SUITE_P(SlowPlays, SlowEngineAgreement, testing::Values(0.0, 50e-6, 100e-6, 200e-6));

}  // namespace
}  // namespace understudy::sim

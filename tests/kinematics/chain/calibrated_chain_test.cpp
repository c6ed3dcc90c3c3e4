// An arm whose axes are not where they were drawn: branches of the closed form, poses of the measured axes.
#include "kinematics/chain/calibrated_chain.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"
#include "tests/kinematics/chain/arm_machines.h"

namespace understudy::kinematics {
namespace {

Vec3 some(Random& random, double sigma) { return sigma * normal_vec3(random); }

ChainDescription measured_arm(std::uint64_t seed) {
  ChainDescription description = sv3x();
  description.design = description.chain;
  Random random(seed, "calibrated chain test");
  for (ChainAxis& axis : description.chain.axes) {
    axis.point += some(random, 1e-3);
    axis.direction = (exp_rotation(some(random, 2e-3)) * axis.direction).normalized();
  }
  description.chain.X_OT_zero.translation() += some(random, 1e-3);
  return description;
}

/// Axes well away from the arm's singular postures.
ArmAxes readings(Random& random) {
  ArmAxes q{};
  for (double& v : q) v = random.uniform(-0.5, 0.5);
  q[1] += 0.3;
  q[4] = random.uniform(0.4, 1.6);
  return q;
}

TEST(CalibratedChain, InversePutsTheMeasuredToolAtThePose) {
  Random random(2, "calibrated chain poses");
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const ChainDescription description = measured_arm(seed);
    const auto mechanism = make_chain_mechanism(description);
    const ArmAxes q = readings(random);
    const Pose X = forward(description.chain, q);
    ArmAxes found{};
    ASSERT_EQ(mechanism->inverse(X, q, found), SolveStatus::ok) << seed;
    EXPECT_LT(position_error(forward(description.chain, found), X), 1e-11) << seed;  // 1e-12 of the solver
    // The pose was made by q: beside q lies q.
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(found[i], q[i], 1e-9) << seed;
  }
}

TEST(CalibratedChain, TakesTheBranchOfTheDrawnArm) {
  const ChainDescription measured = measured_arm(7);
  ChainDescription drawn = sv3x();
  const auto calibrated = make_chain_mechanism(measured), ideal = make_chain_mechanism(drawn);
  Random random(3, "calibrated chain branches");
  for (int k = 0; k < 50; ++k) {
    const Pose X = forward(drawn.chain, readings(random));
    ArmAxes a{}, b{};
    ASSERT_EQ(ideal->inverse(X, {}, a), SolveStatus::ok);
    ASSERT_EQ(calibrated->inverse(X, {}, b), SolveStatus::ok);
    // Errors of 2 mrad and 1 mm on six axes, over the wrist's distance from singular: q5 of 0.4 and more.
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.1);
  }
}

TEST(CalibratedChain, FollowsAPathWithoutAJump) {
  const ChainDescription measured = measured_arm(9);
  const auto mechanism = make_chain_mechanism(measured);
  const Pose from = mechanism->home();
  ArmAxes last{};
  std::copy_n(measured.home.begin(), last.size(), last.begin());
  for (int k = 1; k <= 100; ++k) {
    Pose X = from;
    X.translation() += k * 0.5e-3 * Vec3(0.6, 0.8, 0);
    ArmAxes axes{};
    ASSERT_EQ(mechanism->inverse(X, last, axes), SolveStatus::ok);
    // 0.5 mm at a wrist of 90 mm and more from its axes turns none by 1 degree, away from singular postures.
    for (std::size_t i = 0; i < axes.size(); ++i) EXPECT_NEAR(axes[i], last[i], 0.02) << k;
    last = axes;
  }
}

TEST(CalibratedChain, SaysWhatCannotBeReachedAndWhatIsNoPose) {
  const auto mechanism = make_chain_mechanism(measured_arm(11));
  ArmAxes axes{};
  Pose far = mechanism->home();
  far.translation().x() += 2;
  EXPECT_EQ(mechanism->inverse(far, {}, axes), SolveStatus::unreachable);
  Pose none = mechanism->home();
  none.translation().x() = std::nan("");
  EXPECT_EQ(mechanism->inverse(none, {}, axes), SolveStatus::bad_input);
}

}  // namespace
}  // namespace understudy::kinematics

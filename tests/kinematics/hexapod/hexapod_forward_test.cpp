#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinematics/hexapod/hexapod.h"
#include "tests/kinematics/workspace/workspace_pose.h"

namespace understudy::kinematics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_found(const ForwardResult& result, const Pose& X, const std::string& where) {
  EXPECT_EQ(result.status, SolveStatus::ok) << where;
  EXPECT_LE((result.X_BT.translation() - X.translation()).norm(), 1e-10) << where;
  EXPECT_LE(angle_between(result.X_BT.linear(), X.linear()), 1e-10) << where;
}

void expect_round_trips(int poses, std::uint64_t seed) {
  const HexapodGeometry g = nominal_g4(0.015);
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  Random random(seed, "round trip");
  double iterations = 0;
  int near_home = 0;
  for (int n = 0; n < poses; ++n) {
    const Pose X = workspace_pose(g, joints, random, from_deg(25));
    StrutLengths lengths{};
    ASSERT_EQ(inverse(g, X, lengths), SolveStatus::ok);
    const std::string where = "seed " + std::to_string(seed) + ", pose " + std::to_string(n);
    const ForwardResult cold = forward(g, lengths, Pose::Identity());
    expect_found(cold, X, where + " from home");
    if (angle_between(X.linear(), Mat3::Identity()) <= from_deg(15)) {
      EXPECT_LE(cold.iterations, 6) << where;
      iterations += cold.iterations;
      ++near_home;
    }
    // Warm: 1 mm and 1 deg away, some hundred control cycles.
    const ForwardResult warm = forward(g, lengths, nearby(X, 1e-3, from_deg(1), random));
    expect_found(warm, X, where + " warm");
    EXPECT_LE(warm.iterations, 4) << where;
    if (::testing::Test::HasFailure()) return;
  }
  // docs/reference.md#hexapod-kinematics: mean 5.0 from home within 15 degrees.
  EXPECT_LE(iterations / near_home, 5.0);
}

TEST(HexapodKinematics, ForwardInvertsInverseInTheWorkspace) { expect_round_trips(10'000, 1); }
TEST(SlowHexapodKinematics, ForwardInvertsInverseAcrossTheWorkspace) { expect_round_trips(100'000, 2); }

TEST(HexapodKinematics, ForwardFindsThePoseFromAnyOtherOfTheWorkspace) {
  const HexapodGeometry g = nominal_g4(0.015);
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  Random random(3, "far seeds");
  for (int n = 0; n < 4'000; ++n) {
    const Pose X = workspace_pose(g, joints, random, from_deg(25));
    const Pose seed = workspace_pose(g, joints, random, from_deg(25));
    StrutLengths lengths{};
    ASSERT_EQ(inverse(g, X, lengths), SolveStatus::ok);
    expect_found(forward(g, lengths, seed), X, "pose " + std::to_string(n));
  }
}

// Seeds far outside, in any orientation: the answer may be another assembly or none, but never one on the far
// side of a singularity from its seed, and never a false "ok".
TEST(HexapodKinematics, ForwardNeverCrossesASingularityFromAWildSeed) {
  const HexapodGeometry g = nominal_g4(0.015);
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  Random random(4, "wild seeds");
  int found = 0, refused = 0;
  for (int n = 0; n < 5000; ++n) {
    const Pose X = workspace_pose(g, joints, random, from_deg(25));
    const Pose seed =
        nearby(Pose::Identity(), random.uniform(0, 0.1), random.uniform(0, std::numbers::pi), random);
    StrutLengths lengths{}, lengths_found{};
    Mat6 J_seed;
    ASSERT_EQ(inverse(g, X, lengths), SolveStatus::ok);
    if (jacobian(g, seed, J_seed) != SolveStatus::ok) continue;
    const ForwardResult result = forward(g, lengths, seed);
    ASSERT_TRUE(result.X_BT.matrix().allFinite());
    if (result.status != SolveStatus::ok) {
      ++refused;
      continue;
    }
    ++found;
    Mat6 J_found;
    ASSERT_EQ(jacobian(g, result.X_BT, J_found), SolveStatus::ok);
    EXPECT_GT(J_seed.determinant() * J_found.determinant(), 0) << "wild seed " << n;
    ASSERT_EQ(inverse(g, result.X_BT, lengths_found), SolveStatus::ok);
    for (std::size_t i = 0; i < kStruts; ++i) EXPECT_NEAR(lengths_found[i], lengths[i], 1e-12);
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(refused, 0);
}

// Similar semi-regular hexagons are singular when the platform is turned by 90 degrees about its axis
// (Fichter 1986).
TEST(HexapodKinematics, TheSingularTurnOf90DegreesIsNamed) {
  const HexapodGeometry g = nominal_g4();
  const Pose singular = make_pose(exp_rotation({0, 0, from_deg(90)}), Vec3::Zero());
  EXPECT_GT(condition_number(g, singular), 0.99 * kSingularCondition);
  StrutLengths lengths{};
  ASSERT_EQ(inverse(g, Pose::Identity(), lengths), SolveStatus::ok);
  const ForwardResult result = forward(g, lengths, singular);
  EXPECT_EQ(result.status, SolveStatus::singular);
  EXPECT_TRUE(result.X_BT.matrix().allFinite());
}

TEST(HexapodKinematics, LengthsOfNoPoseDoNotConverge) {
  const HexapodGeometry g = nominal_g4();
  StrutLengths lengths{};
  ASSERT_EQ(inverse(g, Pose::Identity(), lengths), SolveStatus::ok);
  lengths[0] =
      0.6;  // base joint 1 and 2 are 109 mm apart, ball joints 17: by the triangle no closer than 0.4
  const ForwardResult result = forward(g, lengths, Pose::Identity());
  EXPECT_NE(result.status, SolveStatus::ok);
  EXPECT_NE(result.status, SolveStatus::bad_input);
  EXPECT_GT(result.residual, 1e-3);
  EXPECT_LE(result.iterations, ForwardOptions{}.max_iterations);
  EXPECT_TRUE(result.X_BT.matrix().allFinite());
}

TEST(HexapodKinematics, TheIterationCapIsKept) {
  const HexapodGeometry g = nominal_g4();
  StrutLengths lengths{};
  ASSERT_EQ(inverse(g, tilted({0.02, 0.01, 0}, from_deg(15), 1.0), lengths), SolveStatus::ok);
  ForwardOptions options;
  options.max_iterations = 2;
  const ForwardResult result = forward(g, lengths, Pose::Identity(), options);
  EXPECT_EQ(result.status, SolveStatus::not_converged);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_GT(result.residual, options.tolerance);
}

TEST(HexapodKinematics, ForwardNamesBadInputAndReturnsAFinitePose) {
  const HexapodGeometry g = nominal_g4();
  StrutLengths good{};
  ASSERT_EQ(inverse(g, Pose::Identity(), good), SolveStatus::ok);
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity(), 0.0, -0.19}) {
    StrutLengths lengths = good;
    lengths[4] = bad;
    const ForwardResult result = forward(g, lengths, Pose::Identity());
    EXPECT_EQ(result.status, SolveStatus::bad_input) << bad;
    EXPECT_TRUE(result.X_BT.matrix().allFinite());
  }
  Pose seed = Pose::Identity();
  seed.linear() *= 1.01;
  EXPECT_EQ(forward(g, good, seed).status, SolveStatus::bad_input);
  seed = Pose::Identity();
  seed.translation().x() = kNaN;
  EXPECT_EQ(forward(g, good, seed).status, SolveStatus::bad_input);
  EXPECT_TRUE(forward(g, good, seed).X_BT.matrix().allFinite());
}

}  // namespace
}  // namespace understudy::kinematics

#include "kinematics/chain/arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinematics/chain/angles.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/chain/arm_machines.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Standard Denavit-Hartenberg matrix: Rz(theta) Tz(d) Tx(a) Rx(alpha).
Pose denavit_hartenberg(double theta, double d, double a, double alpha) {
  Pose X;
  X.matrix() << std::cos(theta), -std::sin(theta) * std::cos(alpha), std::sin(theta) * std::sin(alpha),
      a * std::cos(theta), std::sin(theta), std::cos(theta) * std::cos(alpha),
      -std::cos(theta) * std::sin(alpha), a * std::sin(theta), 0, std::sin(alpha), std::cos(alpha), d, 0, 0,
      0, 1;
  return X;
}

/// Flange of the SV3X by the table of its parameters, written out apart from the code under test.
Pose flange_by_table(const ArmAxes& q) {
  return denavit_hartenberg(q[0], 0.300, 0.150, -kPi / 2) * denavit_hartenberg(q[1] - kPi / 2, 0, 0.260, 0) *
         denavit_hartenberg(q[2], 0, 0.060, -kPi / 2) * denavit_hartenberg(q[3], 0.260, 0, kPi / 2) *
         denavit_hartenberg(q[4], 0, 0, -kPi / 2) * denavit_hartenberg(q[5], 0.090, 0, 0);
}

/// The tool of sv3x_parameters() on the flange.
Pose tool_by_hand() {
  const double t = from_deg(30);
  Mat3 R_FT;  // Ry(t) Rx(pi)
  R_FT << std::cos(t), 0, -std::sin(t), 0, -1, 0, -std::sin(t), 0, -std::cos(t);
  return make_pose(R_FT, Vec3(0.020, -0.010, 0.100));
}

Pose tool_by_table(const ArmAxes& q) { return flange_by_table(q) * tool_by_hand(); }

ArmGeometry geometry() { return arm_geometry(sv3x_parameters()); }

// A dozen products of numbers below 1: some 1e-15; the contract says 1e-12.
TEST(ArmKinematics, TheChainAgreesWithDenavitHartenbergMatrices) {
  Random random(1, "arm dh");
  const Chain chain = arm_chain(geometry());
  for (int n = 0; n < 2000; ++n) {
    const ArmAxes q = random_axes(random);
    const Pose X = forward(chain, q), expected = tool_by_table(q);
    EXPECT_LE((X.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ArmKinematics, ThePointOfTheToolLooksAwayFromTheFlange) {
  std::vector<double> parameters = sv3x_parameters();
  parameters[9] = 0;
  const Pose X = forward(arm_chain(arm_geometry(parameters)), ArmAxes{});
  EXPECT_LE((tool_axis(X) - Vec3(-1, 0, 0)).norm(), 1e-15);  // the flange looks forwards, along x
}

bool same_turn(const ArmAxes& a, const ArmAxes& b, double tolerance) {
  for (std::size_t i = 0; i < 6; ++i)
    if (std::abs(std::remainder(a[i] - b[i], 2 * kPi)) > tolerance) return false;
  return true;
}

/// Random postures all over the arm: every branch of each reaches the pose; the one it came from is there.
void expect_round_trips(int cases, std::uint64_t seed) {
  Random random(seed, "arm round trip");
  double worst_m = 0, worst_rad = 0;
  int of_8 = 0, of_4 = 0, found_again = 0;
  for (int n = 0; n < cases; ++n) {
    const ArmAxes q = random_axes(random);
    const Pose X = tool_by_table(q);
    ArmSolutions solutions;
    const int count = arm_branches(geometry(), X, solutions.all);
    of_8 += count == 8;
    of_4 += count == 4;
    bool again = false;
    for (int k = 0; k < count; ++k) {
      const ArmSolution& s = solutions.all[static_cast<std::size_t>(k)];
      const Pose reached = tool_by_table(s.axes);
      worst_m = std::max(worst_m, position_error(reached, X));
      worst_rad = std::max(worst_rad, angle_between(reached.linear(), X.linear()));
      // Where a posture is nearly singular, its angles are less exact than the pose: 1e-15 / 1e-6.
      again = again || same_turn(s.axes, q, 1e-6);
    }
    found_again += again;
  }
  // docs/reference.md#robot-arm: 2e-12 mm for the prototype; here 20 roundings of half a metre.
  EXPECT_LE(worst_m, 5e-15);
  EXPECT_LE(worst_rad, 5e-15);
  EXPECT_EQ(of_4 + of_8, cases);  // docs/reference.md#robot-arm: 4 or 8 solutions
  EXPECT_GT(of_8, cases / 4);
  EXPECT_GT(of_4, cases / 20);
  EXPECT_EQ(found_again, cases);
}

TEST(ArmKinematics, EveryBranchPutsTheToolAtThePose) { expect_round_trips(3000, 2); }
TEST(SlowArmKinematics, EveryBranchPutsTheToolAtThePoseAHundredThousandTimes) {
  expect_round_trips(100'000, 3);
}

// The codes by what one sees: the wrist centre before or behind axis 2, the signs of the two other angles.
TEST(ArmKinematics, BranchCodesSayWhatOneSees) {
  Random random(4, "arm codes");
  for (int n = 0; n < 1000; ++n) {
    ArmSolutions solutions;
    const int count = arm_branches(geometry(), tool_by_table(random_axes(random)), solutions.all);
    for (int k = 0; k < count; ++k) {
      const ArmSolution& s = solutions.all[static_cast<std::size_t>(k)];
      const Vec3 wrist = flange_by_table(s.axes) * Vec3(0, 0, -0.090);
      const double forwards = wrist.x() * std::cos(s.axes[0]) + wrist.y() * std::sin(s.axes[0]);
      EXPECT_EQ(s.branch.back, forwards < 0);
      EXPECT_EQ(s.branch.bent_up, std::sin(s.axes[2] + std::atan2(260, 60)) < 0);
      EXPECT_EQ(s.branch.flipped, s.axes[4] < 0);
      for (int other = 0; other < k; ++other)
        EXPECT_FALSE(s.branch == solutions.all[static_cast<std::size_t>(other)].branch);
    }
  }
}

// 150 + 260 + sqrt(60^2 + 260^2) = 676.83 mm (docs/reference.md#robot-arm: 676.8, published 677).
TEST(ArmKinematics, TheWristReachesAsFarAsTheDataSheetSays) {
  const auto tool_for_wrist_at = [](double x) {
    return make_pose(Mat3(Mat3::Identity()), Vec3(x, 0, 0.300)) *
           make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.090)) * tool_by_hand();
  };
  const double reach = 0.15 + 0.26 + std::hypot(0.06, 0.26);
  EXPECT_NEAR(reach, 0.6768, 5e-5);
  ArmSolutions solutions;
  EXPECT_EQ(arm_branches(geometry(), tool_for_wrist_at(reach - 1e-9), solutions.all), 4);
  EXPECT_EQ(arm_branches(geometry(), tool_for_wrist_at(reach + 1e-9), solutions.all), 0);
  // Stretched to the rounding, both elbows are one.
  EXPECT_EQ(arm_branches(geometry(), tool_for_wrist_at(reach), solutions.all), 2);
  for (int k = 0; k < 2; ++k)
    EXPECT_LE(position_error(tool_by_table(solutions.all[static_cast<std::size_t>(k)].axes),
                             tool_for_wrist_at(reach)),
              1e-12);
}

TEST(ArmKinematics, AStraightWristKeepsTheFourthAxis) {
  const ArmAxes q{0.3, 0.4, -0.2, 1.1, 0, -0.4};
  const Pose X = tool_by_table(q);
  ArmSolutions solutions;
  const int count = arm_branches(geometry(), X, solutions.all, q);
  bool kept = false;
  for (int k = 0; k < count; ++k) {
    const ArmSolution& s = solutions.all[static_cast<std::size_t>(k)];
    EXPECT_LE(position_error(tool_by_table(s.axes), X), 1e-14);
    kept = kept || same_turn(s.axes, q, 1e-12);
  }
  EXPECT_TRUE(kept);
  // Without a previous posture it is 0, and j6 does all the turning (docs/reference.md#robot-arm).
  const auto arm = make_chain_mechanism(sv3x());
  ArmAxes found{};
  ASSERT_EQ(arm->inverse(X, {}, found), SolveStatus::ok);
  EXPECT_EQ(found[3], 0);
  EXPECT_NEAR(found[5], 1.1 - 0.4, 1e-12);
}

// From 1e-2 down to rounding off a straight wrist, the pose stays exact though the angles do not.
TEST(ArmKinematics, NearAStraightWristThePoseStaysExact) {
  Random random(5, "arm wrist");
  for (double bend = 1e-2; bend > 1e-18; bend /= 3) {
    ArmAxes q = random_axes(random);
    q[4] = bend;
    const Pose X = tool_by_table(q);
    ArmSolutions solutions;
    const int count = arm_branches(geometry(), X, solutions.all);
    ASSERT_GE(count, 2);
    for (int k = 0; k < count; ++k) {
      const Pose reached = tool_by_table(solutions.all[static_cast<std::size_t>(k)].axes);
      // Less than 1e-13 off straight counts as straight.
      EXPECT_LE(position_error(reached, X), 1e-13) << "bend " << bend;
      EXPECT_LE(angle_between(reached.linear(), X.linear()), 3e-13) << "bend " << bend;
    }
  }
}

TEST(ArmKinematics, AWristOnAxisOneKeepsTheFirstAxis) {
  // Upper arm and forearm leaned back until the wrist centre is over axis 1: solved for q3 by bisection.
  ArmAxes q{0.7, -0.5, 0, 0.2, 0.8, 0.1};
  const auto beside = [&](double q3) {
    q[2] = q3;
    return arm_clearance(geometry(), q).shoulder *
           (0.150 + 0.26 * std::sin(q[1]) + 0.26 * std::cos(q[1] + q3) + 0.06 * std::sin(q[1] + q3) < 0 ? -1
                                                                                                        : 1);
  };
  double low = -kPi, high = 0;
  for (int n = 0; n < 100; ++n) (beside((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  ASSERT_LE(std::abs(beside(high)), 1e-15);
  const Pose X = tool_by_table(q);
  ArmSolutions solutions;
  const int count = arm_branches(geometry(), X, solutions.all, q);
  ASSERT_EQ(count, 4);
  for (int k = 0; k < count; ++k) {
    const ArmSolution& s = solutions.all[static_cast<std::size_t>(k)];
    EXPECT_NEAR(s.axes[0], 0.7, 1e-15);
    EXPECT_LE(position_error(tool_by_table(s.axes), X), 1e-12);
  }
}

TEST(ArmKinematics, WhatIsNoPoseHasNoSolution) {
  const auto arm = make_chain_mechanism(sv3x());
  ArmAxes axes;
  axes.fill(0.5);
  const Pose X_good = arm->home();
  for (const double bad : {kNaN, 1e308, -std::numeric_limits<double>::infinity()})
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) {
        Pose X = X_good;
        X.matrix()(row, column) = bad;
        const SolveStatus expected =
            column == 3 && std::isfinite(bad) ? SolveStatus::unreachable : SolveStatus::bad_input;
        EXPECT_EQ(arm->inverse(X, {}, axes), expected) << row << column << bad;
      }
  Pose mirrored = X_good;
  mirrored.linear().col(0) *= -1;
  EXPECT_EQ(arm->inverse(mirrored, {}, axes), SolveStatus::bad_input);
  const ArmAxes lost{0, 0, kNaN, 0, 0, 0};
  EXPECT_EQ(arm->inverse(X_good, lost, axes), SolveStatus::bad_input);
  EXPECT_EQ(arm->inverse(X_good, {}, std::span(axes).first(5)), SolveStatus::bad_input);
  for (const double v : axes) EXPECT_EQ(v, 0.5);
}

// atan2 of the C library is right to one unit in the last place.
TEST(Angles, OfManyPairsAreThoseOfTheCLibrary) {
  Random random(6, "angles");
  constexpr int kPairs = 4000;
  std::vector<double> sine, cosine, angle(kPairs);
  for (int n = 0; n < kPairs - 8; ++n) {
    const double scale = std::pow(10, random.uniform(-12, 3));
    sine.push_back(scale * random.normal());
    cosine.push_back(scale * random.normal() * (n % 3 == 0 ? 1e-9 : 1));
  }
  for (const double s : {0.0, 1.0, -1.0, -0.0})
    for (const double c : {1.0, -1.0}) {
      sine.push_back(s);
      cosine.push_back(c);
    }
  angles_of(sine.data(), cosine.data(), angle.data(), kPairs);
  for (std::size_t n = 0; n < kPairs; ++n) {
    const double expected = std::atan2(sine[n], cosine[n]);
    const double unit = std::nextafter(std::abs(expected), 4) - std::abs(expected);
    EXPECT_LE(std::abs(angle[n] - expected), 4 * unit) << sine[n] << ' ' << cosine[n];
  }
}

}  // namespace
}  // namespace understudy::kinematics

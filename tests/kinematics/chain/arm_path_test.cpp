// Along a continuous path the arm stays on its branch and its turn.
#include <gtest/gtest.h>

#include <cmath>

#include "core/random_vector.h"
#include "tests/kinematics/chain/arm_machines.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
using Rates = Eigen::Matrix<double, Eigen::Dynamic, 6>;

ChainDescription without_ends() {
  ChainDescription d = sv3x();
  for (ChainAxis& axis : d.chain.axes) axis.lower = -kEndless, axis.upper = kEndless;
  return d;
}

Pose pose_of(const Mechanism& arm, std::span<const double> axes) {
  Pose X = Pose::Identity();
  EXPECT_EQ(arm.forward(axes, Pose::Identity(), X), SolveStatus::ok);
  return X;
}

// The motion is made in the axes, over several turns of j1, j4 and j6 and through every singular posture;
// the inverse sees the poses only and must give the same axes back.
TEST(ArmPath, AxesThatMovedAreFoundAgainOverSeveralTurns) {
  const auto arm = make_chain_mechanism(without_ends());
  ArmAxes previous{0, 0.3, 0.2, 0, 0.6, 0};
  const ArmAxes start = previous;
  constexpr int kSteps = 20'000;
  double worst = 0;
  for (int n = 1; n <= kSteps; ++n) {
    const double t = 2 * kPi * n / kSteps;
    ArmAxes q = start;
    q[0] += 5 * t;
    q[1] += 0.3 * std::sin(7 * t);
    q[2] += 0.3 * std::sin(11 * t);
    q[3] -= 6 * t;
    q[4] += 0.4 * std::sin(5 * t);  // 0.2 to 1.0
    q[5] += 9 * t;
    ArmAxes found{};
    ASSERT_EQ(arm->inverse(pose_of(*arm, q), previous, found), SolveStatus::ok);
    for (std::size_t i = 0; i < 6; ++i) worst = std::max(worst, std::abs(found[i] - q[i]));
    previous = found;
  }
  EXPECT_LE(worst, 1e-12);  // 1e-15 over a clearance of 0.2, and 60 rad of turns
}

// j5 swings through 0: at exactly 0 j4 and j6 are free and must stay.
TEST(ArmPath, AWristThatSwingsThroughStraightDoesNotFlip) {
  const auto arm = make_chain_mechanism(without_ends());
  ArmAxes previous{0.2, 0.3, 0.2, 0.5, -0.3, 1.0};
  for (int n = -300; n <= 300; ++n) {
    const ArmAxes q{0.2, 0.3, 0.2, 0.5, 1e-3 * n, 1.0};
    ArmAxes found{};
    ASSERT_EQ(arm->inverse(pose_of(*arm, q), previous, found), SolveStatus::ok);
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(found[i], q[i], 1e-11) << "axis " << i << " step " << n;
    previous = found;
  }
}

/// Walks from one pose to another; no step of the axes may be longer than the rates at its two ends explain.
void expect_no_jump(const Pose& from, const Pose& to, ArmAxes previous, int steps) {
  const auto arm = make_chain_mechanism(without_ends());
  const Twist twist = [&] {
    Twist t;
    t << (to.translation() - from.translation()) / steps,
        from.linear() * log_rotation(from.linear().transpose() * to.linear()) / steps;
    return t;
  }();
  Rates before(6, 6), after(6, 6);
  ASSERT_EQ(arm->axis_rates(from, previous, before), SolveStatus::ok);
  for (int n = 1; n <= steps; ++n) {
    const Pose X = interpolate(from, to, static_cast<double>(n) / steps);
    ArmAxes axes{};
    ASSERT_EQ(arm->inverse(X, previous, axes), SolveStatus::ok);
    ASSERT_EQ(arm->axis_rates(X, axes, after), SolveStatus::ok);
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double step = std::abs(axes[k] - previous[k]);
      const double explained =
          std::max(std::abs(before.row(i).dot(twist)), std::abs(after.row(i).dot(twist)));
      // Within a step rates change; with these step lengths by less than half.
      ASSERT_LE(step, 1.5 * explained + 1e-6) << "axis " << i + 1 << " step " << n;
    }
    previous = axes;
    before = after;
  }
}

TEST(ArmPath, StraightLinesWithATiltingToolHaveNoJump) {
  Random random(31, "arm lines");
  const auto arm = make_chain_mechanism(without_ends());
  const ArmAxes home{0, 0.35, 0.17, 0.1, 1.05, 0};
  const Pose X_home = pose_of(*arm, home);
  for (int n = 0; n < 40; ++n) {
    const auto small = [&](double size) { return uniform_vec3(random, size); };
    const Pose to =
        make_pose(Mat3(exp_rotation(small(0.4)) * X_home.linear()), X_home.translation() + small(0.06));
    expect_no_jump(X_home, to, home, 500);
  }
}

// The tool swings past a straight wrist at a few thousandths of a radian: j4 and j6 must turn by nearly half
// a turn against each other within a short way, but without a jump.
TEST(ArmPath, PastAStraightWristTheAxesTurnFastButDoNotJump) {
  const auto arm = make_chain_mechanism(without_ends());
  for (const double miss : {3e-2, 1e-2, 3e-3}) {
    const ArmAxes start{0.2, 0.3, 0.2, 0.0, -0.3, 0.0};
    const Pose X_straight = pose_of(*arm, ArmAxes{0.2, 0.3, 0.2, 0, 0, 0});
    // Turn about the wrist centre, beside the plane in which j5 alone would turn.
    const Chain chain = arm_chain(arm_geometry(sv3x_parameters()));
    std::array<Pose, 6> links;
    link_poses(chain, ArmAxes{0.2, 0.3, 0.2, 0, 0, 0}, links);
    const Vec3 across = links[4].linear() * Vec3::UnitY(), forearm = links[3].linear() * Vec3::UnitX();
    const Vec3 p_wrist = links[4] * chain.axes[4].point;
    const auto turned = [&](double swing) {
      const Mat3 R = exp_rotation(swing * across) * exp_rotation(miss * forearm.cross(across));
      return make_pose(Mat3(R * X_straight.linear()), p_wrist + R * (X_straight.translation() - p_wrist));
    };
    ArmAxes axes{};
    ASSERT_EQ(arm->inverse(turned(-0.3), start, axes), SolveStatus::ok);
    ArmAxes previous = axes;
    double fastest = 0, turn4 = 0;
    constexpr int kSteps = 6000;  // 0.1 mrad each, a thirtieth of the nearest miss
    for (int n = 1; n <= kSteps; ++n) {
      const double swing = -0.3 + 0.6 * n / kSteps;
      ASSERT_EQ(arm->inverse(turned(swing), previous, axes), SolveStatus::ok);
      for (std::size_t i = 0; i < 6; ++i) fastest = std::max(fastest, std::abs(axes[i] - previous[i]));
      turn4 += axes[3] - previous[3];
      previous = axes;
    }
    // Past a straight wrist at the angle m, q4 = atan(swing / m): it turns at most 1/m as fast as the tool.
    EXPECT_LE(fastest, 0.6 / kSteps / std::sin(miss) * 1.01) << miss;
    EXPECT_GE(fastest, 0.6 / kSteps / std::sin(miss) * 0.9) << miss;
    EXPECT_NEAR(std::abs(turn4), 2 * std::atan2(std::sin(0.3), std::tan(miss)), 0.01) << miss;
  }
}

}  // namespace
}  // namespace understudy::kinematics

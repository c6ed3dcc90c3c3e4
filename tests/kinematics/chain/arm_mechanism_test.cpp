// The arm behind the interface of every machine: choice of branch and turn, rates, limits, singular postures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinematics/chain/chain_kind.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/chain/arm_machines.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
using Rates = Eigen::Matrix<double, Eigen::Dynamic, 6>;

Pose pose_of(const Mechanism& arm, std::span<const double> axes) {
  Pose X = Pose::Identity();
  EXPECT_EQ(arm.forward(axes, Pose::Identity(), X), SolveStatus::ok);
  return X;
}

/// Within the ranges, and clear of singular postures by the given angle.
ArmAxes good_axes(Random& random, double clear) {
  const ChainDescription d = sv3x();
  for (;;) {
    ArmAxes q{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = random.uniform(d.chain.axes[i].lower, d.chain.axes[i].upper);
    const ArmClearance at = arm_clearance(arm_geometry(d.parameters), q);
    if (at.wrist > clear && at.elbow > 0.1 * clear * clear && at.shoulder > clear) return q;
  }
}

TEST(ArmMechanism, IsMadeByTheNameOfItsKind) {
  const ChainKind* kind = find_chain_kind("arm");
  ASSERT_NE(kind, nullptr);
  ASSERT_EQ(kind->parameters.size(), 10u);
  EXPECT_EQ(kind->parameters[0].key, "d1_mm");
  EXPECT_EQ(kind->parameters[9].key, "tool_tilt_deg");
  const auto arm = make_chain_mechanism(sv3x());
  EXPECT_EQ(arm->axis_count(), 6);
  EXPECT_EQ(arm->axis_name(3), "j4");
  EXPECT_TRUE(arm->axis_is_angle(5));
  EXPECT_TRUE(arm->follows_spin());
  EXPECT_DOUBLE_EQ(arm->axis_range(1).upper, from_deg(150));
}

TEST(ArmMechanism, FindsTheAxesAgainFromAPostureNearby) {
  Random random(21, "arm near");
  const auto arm = make_chain_mechanism(sv3x());
  for (int n = 0; n < 2000; ++n) {
    const ArmAxes q = good_axes(random, 0.1);
    ArmAxes beside = q, found{};
    for (double& v : beside) v += random.uniform(-0.02, 0.02);
    ASSERT_EQ(arm->inverse(pose_of(*arm, q), beside, found), SolveStatus::ok);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], q[i], 1e-12);  // 1e-15 over the clearance
  }
}

TEST(ArmMechanism, StaysOnTheTurnThatItIsOn) {
  const auto arm = make_chain_mechanism(sv3x());
  ArmAxes q{0.1, 0.3, 0.1, 0.2, 0.9, from_deg(300)}, found{};
  ASSERT_EQ(arm->inverse(pose_of(*arm, q), q, found), SolveStatus::ok);
  EXPECT_NEAR(found[5], from_deg(300), 1e-12);
  q[5] = from_deg(-300);
  ASSERT_EQ(arm->inverse(pose_of(*arm, q), q, found), SolveStatus::ok);
  EXPECT_NEAR(found[5], from_deg(-300), 1e-12);
}

TEST(ArmMechanism, TakesAnotherTurnWhereTheNearestIsOutOfRange) {
  ChainDescription d = sv3x();
  d.chain.axes[3].lower = -1, d.chain.axes[3].upper = 1;  // no room for the flipped wrist
  const auto arm = make_chain_mechanism(d);
  // From 345 degrees the nearest turn of 0 is 360, beyond the 350 of the range.
  const ArmAxes q{0.1, 0.3, 0.1, 0.2, 0.9, 0};
  ArmAxes beside = q, found{};
  beside[5] = from_deg(345);
  ASSERT_EQ(arm->inverse(pose_of(*arm, q), beside, found), SolveStatus::ok);
  EXPECT_NEAR(found[5], 0, 1e-12);
}

// q5 = 1.2 with q3 out of its range is nearest to `previous`, but another branch is within all ranges.
TEST(ArmMechanism, PrefersABranchWithinTheRangesToANearerOneBeyond) {
  const ChainDescription d = sv3x();
  const auto arm = make_chain_mechanism(d);
  Random random(22, "arm ranges");
  int chosen = 0;
  for (int n = 0; n < 300; ++n) {
    const ArmAxes q = good_axes(random, 0.1);
    ArmSolutions all;
    const Pose X = pose_of(*arm, q);
    all.count = arm_branches(arm_geometry(d.parameters), X, all.all);
    for (int k = 0; k < all.count; ++k) {
      ArmAxes beyond = all.all[static_cast<std::size_t>(k)].axes, found{};
      if (beyond[1] >= d.chain.axes[1].lower - 0.3 || q[1] < d.chain.axes[1].lower) continue;
      for (double& v : beyond) v += 0.25;  // farther than a step of a path
      ASSERT_EQ(arm->inverse(X, beyond, found), SolveStatus::ok);
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_GE(found[i], d.chain.axes[i].lower);
        EXPECT_LE(found[i], d.chain.axes[i].upper);
      }
      ++chosen;
    }
  }
  EXPECT_GT(chosen, 100);
}

TEST(ArmMechanism, FollowsItsBranchBeyondTheRangesAndSaysSo) {
  const auto arm = make_chain_mechanism(sv3x());
  const ArmAxes q{0.1, 0.3, 0.1, 0.2, from_deg(135.5), 0}, before{0.1, 0.3, 0.1, 0.2, from_deg(134.9), 0};
  ArmAxes found{};
  ASSERT_EQ(arm->inverse(pose_of(*arm, q), before, found), SolveStatus::ok);
  EXPECT_NEAR(found[4], q[4], 1e-12);
  std::vector<LimitViolation> violations;
  arm->check(pose_of(*arm, q), found, violations);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(to_string(violations[0]), "axis j5 is at 135.5 deg, above 135.0 deg");
}

TEST(ArmMechanism, DoesNotLeapATurnBackAtTheEndOfARange) {
  const auto arm = make_chain_mechanism(sv3x());
  const ArmAxes q{0.1, 0.3, 0.1, from_deg(180.1), 0.9, 0}, before{0.1, 0.3, 0.1, from_deg(179.9), 0.9, 0};
  ArmAxes found{};
  ASSERT_EQ(arm->inverse(pose_of(*arm, q), before, found), SolveStatus::ok);
  EXPECT_NEAR(found[3], q[3], 1e-12);
}

// Central differences of the inverse, h = 1e-5: truncation h^2 q''' / 6. With clearances above 0.3 third
// derivatives stay below some 1e3 rad/m^3 of 1/(0.1 m)^3; rounding 1e-15 / 1e-5 / 0.3.
void expect_rates(int cases, std::uint64_t seed) {
  Random random(seed, "arm rates");
  const auto arm = make_chain_mechanism(sv3x());
  const double h = 1e-5;
  double worst = 0;
  for (int n = 0; n < cases; ++n) {
    const ArmAxes q = good_axes(random, 0.3);
    const Pose X = pose_of(*arm, q);
    Rates rates(6, 6);
    ASSERT_EQ(arm->axis_rates(X, q, rates), SolveStatus::ok);
    for (int column = 0; column < 6; ++column) {
      Twist twist = Twist::Zero();
      twist[column] = h;
      const auto moved = [&](double sign) {
        ArmAxes found{};
        EXPECT_EQ(arm->inverse(make_pose(Mat3(exp_rotation(sign * twist.tail<3>()) * X.linear()),
                                         X.translation() + sign * twist.head<3>()),
                               q, found),
                  SolveStatus::ok);
        return found;
      };
      const ArmAxes ahead = moved(1), behind = moved(-1);
      for (int i = 0; i < 6; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double difference = (ahead[k] - behind[k]) / (2 * h);
        worst = std::max(worst, std::abs(rates(i, column) - difference) / rates.norm());
      }
    }
  }
  EXPECT_LE(worst, 1e-6);
}
TEST(ArmMechanism, AxisRatesAreTheDerivativeOfTheInverse) { expect_rates(500, 23); }
TEST(SlowArmMechanism, AxisRatesAreTheDerivativeOfTheInverseAHundredThousandTimes) {
  expect_rates(100'000, 24);
}

TEST(ArmMechanism, ClearanceIsThatOfTheTriangleOfTheArm) {
  const ArmGeometry g = arm_geometry(sv3x_parameters());
  // All axes 0: forearm level, so the wrist centre is 410 mm before axis 1; the triangle 260, 266.83 with
  // the elbow's right angle less that of the offset has the third side sqrt(260^2 + 320^2).
  const ArmClearance at = arm_clearance(g, ArmAxes{0, 0, 0, 0, 0.3, 0});
  EXPECT_NEAR(at.wrist, 0.3, 1e-15);
  EXPECT_NEAR(at.shoulder, 0.410, 1e-15);
  EXPECT_NEAR(at.elbow, 0.26 + std::hypot(0.06, 0.26) - std::hypot(0.26, 0.32), 1e-15);
  EXPECT_NEAR(arm_clearance(g, ArmAxes{0, 0, 0, 0, kPi - 0.2, 0}).wrist, 0.2, 1e-14);
}

TEST(ArmMechanism, CheckNamesTheSingularPostureThatIsNear) {
  const auto arm = make_chain_mechanism(sv3x());
  const auto reported = [&](const ArmAxes& q) {
    std::vector<LimitViolation> violations;
    arm->check(pose_of(*arm, q), q, violations);
    std::vector<std::string> lines;
    for (const auto& v : violations)
      if (v.kind == LimitKind::singularity) lines.push_back(to_string(v));
    return lines;
  };
  using testing::ElementsAre;
  EXPECT_THAT(reported({0.1, 0.3, 0.1, 0.2, 0.9, 0}), ElementsAre());
  EXPECT_THAT(reported({0.1, 0.3, 0.1, 0.2, 0.02, 0}),
              ElementsAre("wrist is 1.1 deg from a singular position, nearer than 2.9 deg"));
  const double straight = -std::atan2(260, 60);
  EXPECT_THAT(reported({0.1, 0.9, straight + 0.1, 0.2, 0.9, 0}),
              ElementsAre("elbow is 0.7 mm from a singular position, nearer than 1.5 mm"));
}

TEST(ArmMechanism, AWristNearAxisOneIsNamedTheShoulder) {
  const auto arm = make_chain_mechanism(sv3x());
  ArmAxes q{0.1, -0.5, 0, 0.2, 0.9, 0};
  // Bisection for the wrist centre 10 mm before axis 1.
  double low = -kPi, high = 0;
  for (int n = 0; n < 100; ++n) {
    const double m = (low + high) / 2;
    const double before =
        0.15 + 0.26 * std::sin(q[1]) + 0.26 * std::cos(q[1] + m) + 0.06 * std::sin(q[1] + m);
    (before < 0.010 ? low : high) = m;
  }
  q[2] = low;
  std::vector<LimitViolation> violations;
  arm->check(pose_of(*arm, q), q, violations);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(to_string(violations[0]), "shoulder is 10.0 mm from a singular position, nearer than 20.0 mm");
}

TEST(ArmMechanism, AnUnreachablePoseIsReportedAsSuch) {
  const auto arm = make_chain_mechanism(sv3x());
  Pose X = arm->home();
  X.translation().x() += 2;
  ArmAxes axes{};
  EXPECT_EQ(arm->inverse(X, {}, axes), SolveStatus::unreachable);
  std::vector<LimitViolation> violations;
  arm->check(X, {}, violations);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations[0].kind, LimitKind::unreachable);
}

TEST(ArmMechanism, AtAStraightWristRatesAreFilledAndCalledSingular) {
  const auto arm = make_chain_mechanism(sv3x());
  const ArmAxes q{0.1, 0.3, 0.1, 0.2, 0, 0};
  Rates rates(6, 6);
  EXPECT_EQ(arm->axis_rates(pose_of(*arm, q), q, rates), SolveStatus::singular);
  EXPECT_TRUE(rates.allFinite());
  EXPECT_GT(arm->condition_number(pose_of(*arm, q), q), 1e6);
}

TEST(ArmMechanism, CallsDoNotAllocate) {
  const auto arm = make_chain_mechanism(sv3x());
  const ArmAxes q{0.1, 0.3, 0.1, 0.2, 0.9, 0};
  const Pose X = pose_of(*arm, q);
  Pose far = X;
  far.translation().x() += 2;
  ArmAxes found{};
  Pose reached = Pose::Identity();
  Rates rates(6, 6);
  const long before = allocations();
  SolveStatus all = arm->inverse(X, q, found);
  if (arm->inverse(far, q, found) != SolveStatus::unreachable) all = SolveStatus::bad_input;
  if (arm->forward(q, X, reached) != SolveStatus::ok) all = SolveStatus::bad_input;
  if (arm->axis_rates(X, q, rates) != SolveStatus::ok) all = SolveStatus::bad_input;
  const double condition = arm->condition_number(X, q);
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(all, SolveStatus::ok);
  EXPECT_GT(condition, 1);
}

}  // namespace
}  // namespace understudy::kinematics

#include "kinematics/chain/finishing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/minimum_norm.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/rate_check.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr FinishingGeometry kStage{0.25, 0.08};
using Axes = std::array<double, kFinishingAxes>;

ChainDescription described() {
  ChainDescription d;
  d.kind = "finishing";
  d.parameters = {kStage.l3, kStage.le};
  d.chain = finishing_chain(kStage);
  d.home = {0, 0, 0, 0, 0, 0};
  return d;
}

Axes random_axes(Random& random) {
  return {random.uniform(-0.2, 0.2), random.uniform(-kPi, kPi), random.uniform(-0.1, 0.1),
          random.uniform(-0.1, 0.1), random.uniform(-1.5, 1.5), random.uniform(-1.2, 1.2)};
}

// Yu 2023, definitions A1-A3: e^[S q] of a screw with omega and v.
Eigen::Matrix4d exponential(const Vec3& omega, const Vec3& v, double q) {
  Mat3 hat;
  hat << 0, -omega.z(), omega.y(), omega.z(), 0, -omega.x(), -omega.y(), omega.x(), 0;
  const Mat3 I = Mat3::Identity();
  Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
  X.topLeftCorner<3, 3>() = I + std::sin(q) * hat + (1 - std::cos(q)) * hat * hat;
  X.topRightCorner<3, 1>() = (I * q + (1 - std::cos(q)) * hat + (q - std::sin(q)) * hat * hat) * v;
  return X;
}

// Eq 2 with table 1, whose v = -omega x q with q = (-L3, 0, 0).
Eigen::Matrix4d of_the_paper(const Axes& q) {
  const Vec3 z = Vec3::UnitZ(), none = Vec3::Zero();
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  M(0, 3) = -kStage.l3 + kStage.le;
  return exponential(none, z, q[0]) * exponential(z, none, q[1]) * exponential(none, Vec3::UnitX(), q[2]) *
         exponential(none, Vec3::UnitY(), q[3]) * exponential(z, Vec3(0, kStage.l3, 0), q[4]) *
         exponential(Vec3::UnitY(), Vec3(0, 0, -kStage.l3), q[5]) * M;
}

TEST(Finishing, ChainIsTheProductOfExponentialsOfThePaper) {
  const Chain chain = finishing_chain(kStage);
  // {b} to T: the tool's axis against x of {b}, x of T up.
  Eigen::Matrix4d X_bT = Eigen::Matrix4d::Zero();
  X_bT(2, 0) = X_bT(1, 1) = X_bT(3, 3) = 1;
  X_bT(0, 2) = -1;
  Random random(41, "finishing");
  for (int n = 0; n < 2000; ++n) {
    const Axes q = random_axes(random);
    EXPECT_LE((forward(chain, q).matrix() - of_the_paper(q) * X_bT).norm(), 3e-15) << n;
  }
}

void expect_reached(const Mechanism& mechanism, const Pose& X, std::span<const double> q, int n) {
  Pose X_found = Pose::Identity();
  ASSERT_EQ(mechanism.forward(q, X, X_found), SolveStatus::ok);
  EXPECT_LE((X_found.translation() - X.translation()).norm(), 1e-10) << "pose " << n;
  EXPECT_LE(tool_axis_angle(X_found, X), 1e-10) << "pose " << n;
}

void expect_round_trips(int poses, std::uint64_t seed) {
  Random random(seed, "finishing round trip");
  const ChainDescription d = described();
  const auto mechanism = make_chain_mechanism(d);
  for (int n = 0; n < poses; ++n) {
    const Pose X = forward(d.chain, random_axes(random));
    Axes from_home{}, from_anywhere{};
    const Axes previous = random_axes(random);
    ASSERT_EQ(mechanism->inverse(X, {}, from_home), SolveStatus::ok) << n;
    ASSERT_EQ(mechanism->inverse(X, previous, from_anywhere), SolveStatus::ok) << n;
    expect_reached(*mechanism, X, from_home, n);
    expect_reached(*mechanism, X, from_anywhere, n);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Finishing, InverseReachesEveryPose) { expect_round_trips(1'000, 42); }
TEST(SlowFinishing, InverseReachesEveryPose) { expect_round_trips(100'000, 43); }

void expect_rates_of_differences(int poses, std::uint64_t seed) {
  Random random(seed, "finishing rates");
  const ChainDescription d = described();
  const auto mechanism = make_chain_mechanism(d);
  for (int n = 0; n < poses; ++n) {
    const Axes q = random_axes(random);
    EXPECT_LE(worst_rate_difference(*mechanism, forward(d.chain, q), q), 1e-7) << seed << " pose " << n;
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Finishing, RatesAreTheDerivativesOfTheInverse) { expect_rates_of_differences(300, 44); }
TEST(SlowFinishing, RatesAreTheDerivativesOfTheInverse) { expect_rates_of_differences(100'000, 45); }

Twist random_twist(Random& random) {
  Twist twist;
  for (double& v : twist) v = random.normal();
  return twist;
}

double norm(const Axes& rates, double metric) {
  double sum = 0;
  for (std::size_t i = 0; i < kFinishingAxes; ++i) {
    const bool angle = i == 1 || i >= 4;
    sum += std::pow(rates[i] * (angle ? metric : 1), 2);
  }
  return std::sqrt(sum);
}

// The twist is made but for its spin; every other way to make it, told by its null-space motion, is longer; a
// null-space motion moves only the spin.
TEST(MinimumNorm, RatesMakeTheTwistAndNoOthersAreShorter) {
  Random random(46, "minimum norm");
  const Chain chain = finishing_chain(kStage);
  for (int n = 0; n < 500; ++n) {
    const Axes q = random_axes(random);
    const double metric = random.uniform(0.02, 0.5);
    const Twist twist = random_twist(random);
    ChainJacobian J;
    const Pose X = forward(chain, q, J);
    Axes rates{}, others{}, z{};
    for (double& v : z) v = random.normal();
    ASSERT_EQ(minimum_norm_rates(chain, q, twist, metric, {}, rates), SolveStatus::ok);
    ASSERT_EQ(minimum_norm_rates(chain, q, twist, metric, z, others), SolveStatus::ok);
    for (const Axes& some : {rates, others}) {
      const Twist made = J * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(some.data());
      EXPECT_LE((made.head<3>() - twist.head<3>()).norm(), 1e-11);
      EXPECT_LE((made.tail<3>() - twist.tail<3>()).cross(tool_axis(X)).norm(), 1e-11);
    }
    EXPECT_GT(norm(others, metric), norm(rates, metric));
    // Pythagoras in the metric: what was added is perpendicular to the smallest.
    Axes added{};
    for (std::size_t i = 0; i < kFinishingAxes; ++i) added[i] = others[i] - rates[i];
    EXPECT_NEAR(std::hypot(norm(rates, metric), norm(added, metric)), norm(others, metric),
                1e-11 * norm(others, metric));
  }
}

// docs/reference.md#finishing-stage: six axes, rank 5. The free motion turns bed and wrist against each other
// and slides along.
TEST(MinimumNorm, TheStageHasOneRedundantMotion) {
  Random random(47, "redundancy");
  const Chain chain = finishing_chain(kStage);
  for (int n = 0; n < 100; ++n) {
    const Axes q = random_axes(random);
    ChainJacobian J;
    forward(chain, q, J);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd{Eigen::MatrixXd(J)};
    EXPECT_GT(svd.singularValues()(4), 1e-3);
    EXPECT_LT(svd.singularValues()(5), 1e-15);
  }
}

// Both axes turn the tool alike; the cheaper share for each follows from the metric: with a heavy radian bed
// and wrist divide a turn evenly, as 2 (t/2)^2 < t^2.
TEST(MinimumNorm, HeavyRadiansAreSharedBetweenBedAndWrist) {
  const Chain chain = finishing_chain(kStage);
  Axes rates{};
  const Axes home{};
  Twist turn = Twist::Zero();
  turn[5] = 1;
  ASSERT_EQ(minimum_norm_rates(chain, home, turn, 100.0, {}, rates), SolveStatus::ok);
  EXPECT_NEAR(rates[1], 0.5, 1e-5);
  EXPECT_NEAR(rates[4], 0.5, 1e-5);
  // Light radians: slides would pay for the tip's own way. Bed only: the tip at radius 0.17 m is carried
  // along; wrist only: the arm of 0.08 m. By Lagrange on c + yaw = 1 with v = 0.17 c - 0.08 yaw to undo.
  ASSERT_EQ(minimum_norm_rates(chain, home, turn, 1e-3, {}, rates), SolveStatus::ok);
  EXPECT_NEAR(rates[1] * (kStage.le - kStage.l3) + rates[4] * kStage.le, 0, 1e-5);
}

ChainDescription with_ranges_of_the_paper() {
  ChainDescription d = described();
  d.length_scale = 1;  // plain norm of SI rates
  const std::array<double, 2> ranges[] = {{-0.02, 0.4},  {},           {-0.05, 0.4}, {-0.15, 0.15},
                                          {-1.75, 1.75}, {-1.75, 1.75}};
  for (const std::size_t i : {0u, 2u, 3u, 4u, 5u})
    d.chain.axes[i].lower = ranges[i][0], d.chain.axes[i].upper = ranges[i][1];
  d.home = {0, 0, 0.1, 0, 0, 0};
  return d;
}

// A level tool goes three times round an ellipse. The plain norm shares the turns between bed and wrist, and
// takes the wrist past its end within the first.
TEST(Finishing, GoesRoundAPartAgainAndAgainWithinItsRanges) {
  const ChainDescription d = with_ranges_of_the_paper();
  const auto mechanism = make_chain_mechanism(d);
  Axes q = {0, 0, 0.1, 0, 0, 0};
  constexpr int kSteps = 1000;
  for (int n = 0; n <= 3 * kSteps; ++n) {
    const double t = kPi + 2 * kPi * n / kSteps, turn = std::atan2(std::sin(t) / 0.035, std::cos(t) / 0.05);
    const Mat3 R = exp_rotation((turn - kPi) * Vec3::UnitZ()) * forward(d.chain, Axes{}).linear();
    const Pose X = make_pose(R, Vec3(0.05 * std::cos(t), 0.035 * std::sin(t), 0));
    ASSERT_EQ(mechanism->inverse(X, n > 0 ? q : Axes{0, 0, 0.1, 0, 0, 0}, q), SolveStatus::ok);
    expect_reached(*mechanism, X, q, n);
    std::vector<LimitViolation> violations;
    mechanism->check(X, q, violations);
    ASSERT_TRUE(violations.empty()) << n << ": " << to_string(violations.front());
  }
  EXPECT_NEAR(std::abs(q[1] + q[4]), 6 * kPi, 1e-9) << "bed and wrist together went round three times";
}

TEST(Finishing, RatesAreTheDerivativesOfTheInverseNearEndsOfRanges) {
  const ChainDescription d = with_ranges_of_the_paper();
  const auto mechanism = make_chain_mechanism(d);
  for (const double yaw : {-1.7, 1.2, 1.6, 1.74}) {
    const Axes q{0.1, 0.3, 0.38, -0.12, yaw, 0.2};
    EXPECT_LE(worst_rate_difference(*mechanism, forward(d.chain, q), q), 1e-6) << yaw;
  }
}

TEST(MinimumNorm, AnAxisCountsMoreTowardsTheEndsOfItsRange) {
  ChainAxis axis = turning_axis("yaw", Vec3::UnitZ(), Vec3::Zero(), -1);
  EXPECT_EQ(range_weight(axis, 100), 1) << "without ends";
  axis.lower = -1, axis.upper = 3;  // the middle is 1, a half 2
  for (const double q : {-0.6, 0.0, 1.0, 2.6}) EXPECT_NEAR(range_weight(axis, q), 1, 1e-12) << q;
  // Half way through the last fifth: 1 + (0.5 / 0.5)^2.
  EXPECT_NEAR(range_weight(axis, 2.8), 2, 1e-9);
  EXPECT_NEAR(range_weight(axis, -0.8), 2, 1e-9);
  EXPECT_GT(range_weight(axis, 3), 9000);
  EXPECT_EQ(range_weight(axis, 3), range_weight(axis, 4)) << "beyond the end it stays finite";
}

TEST(Finishing, VerticalToolIsReachedAllTheSame) {
  const auto mechanism = make_chain_mechanism(described());
  for (const double pitch : {kPi / 2, -kPi / 2}) {
    const Pose X = forward(described().chain, Axes{0.01, 0.4, 0.02, -0.03, 0.2, pitch});
    Axes q{};
    ASSERT_EQ(mechanism->inverse(X, {}, q), SolveStatus::ok);
    expect_reached(*mechanism, X, q, 0);
    // From there to a level tool that points sideways: no rate of the axes begins that turn.
    const Pose X_level = forward(described().chain, Axes{0, 1, 0.02, -0.03, 0.9, 0});
    Axes next{};
    ASSERT_EQ(mechanism->inverse(X_level, q, next), SolveStatus::ok);
    expect_reached(*mechanism, X_level, next, 1);
    Eigen::Matrix<double, Eigen::Dynamic, 6> rates(6, 6);
    Axes vertical{0.01, 0.4, 0.02, -0.03, 0.2, pitch};
    EXPECT_EQ(mechanism->axis_rates(X, vertical, rates), SolveStatus::singular);
    EXPECT_TRUE(rates.allFinite());
  }
}

TEST(Finishing, OppositeToolAxisIsReached) {
  const auto mechanism = make_chain_mechanism(described());
  const Pose X = forward(described().chain, Axes{});
  const Pose X_opposite = make_pose(Mat3(exp_rotation(kPi * Vec3::UnitZ()) * X.linear()), X.translation());
  Axes q{};
  ASSERT_EQ(mechanism->inverse(X_opposite, {}, q), SolveStatus::ok);
  expect_reached(*mechanism, X_opposite, q, 0);
}

// The wrist's slides reach one side of the bed only; the bed must bring the part round.
TEST(Finishing, ColdStartTurnsTheBedWhereSlidesEnd) {
  ChainDescription d = described();
  for (const std::size_t slide : {2u, 3u}) {
    d.chain.axes[slide].lower = -0.06;
    d.chain.axes[slide].upper = 0.06;
  }
  d.chain.axes[4].lower = -1.6;
  d.chain.axes[4].upper = 1.6;
  const auto mechanism = make_chain_mechanism(d);
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const double turn = from_deg(degrees);
    const Mat3 R = exp_rotation(turn * Vec3::UnitZ()) * forward(d.chain, Axes{}).linear();
    const Pose X = make_pose(R, Vec3(-0.15 * std::cos(turn), -0.15 * std::sin(turn), 0));
    Axes q{};
    ASSERT_EQ(mechanism->inverse(X, {}, q), SolveStatus::ok);
    expect_reached(*mechanism, X, q, degrees);
    std::vector<LimitViolation> violations;
    mechanism->check(X, q, violations);
    EXPECT_TRUE(violations.empty()) << degrees << ": " << to_string(violations.front());
  }
}

TEST(Finishing, BadInputIsNamedAndLeavesTheAxesAlone) {
  const auto mechanism = make_chain_mechanism(described());
  const Chain chain = finishing_chain(kStage);
  const Axes kept{1, 2, 3, 4, 5, 6};
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    Axes q = kept, broken{};
    Pose X = Pose::Identity();
    X.translation().z() = bad;
    EXPECT_EQ(mechanism->inverse(X, {}, q), SolveStatus::bad_input);
    X = Pose::Identity();
    X.linear()(2, 2) = bad;
    EXPECT_EQ(mechanism->inverse(X, {}, q), SolveStatus::bad_input);
    broken[2] = bad;
    EXPECT_EQ(mechanism->inverse(Pose::Identity(), broken, q), SolveStatus::bad_input);
    Twist twist = Twist::Zero();
    twist[1] = bad;
    EXPECT_EQ(minimum_norm_rates(chain, Axes{}, twist, 0.1, {}, q), SolveStatus::bad_input);
    EXPECT_EQ(minimum_norm_rates(chain, broken, Twist::Zero(), 0.1, {}, q), SolveStatus::bad_input);
    EXPECT_EQ(minimum_norm_rates(chain, Axes{}, Twist::Zero(), bad, {}, q), SolveStatus::bad_input);
    EXPECT_EQ(minimum_norm_rates(chain, Axes{}, Twist::Zero(), 0.1, broken, q), SolveStatus::bad_input);
    EXPECT_EQ(q, kept);
  }
}

TEST(Finishing, NothingAllocates) {
  const auto mechanism = make_chain_mechanism(described());
  const Chain chain = finishing_chain(kStage);
  Random random(48, "allocation");
  double sink = 0;
  const long before = allocations();
  for (int n = 0; n < 50; ++n) {
    const Axes q = random_axes(random);
    Axes found{};
    Pose X = Pose::Identity();
    Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxAxes, 6> rates(kFinishingAxes, 6);
    sink += mechanism->forward(q, X, X) == SolveStatus::ok;
    sink += mechanism->inverse(X, {}, found) == SolveStatus::ok;
    sink += mechanism->axis_rates(X, found, rates) == SolveStatus::ok;
    sink += found[0] + rates(0, 0) + mechanism->condition_number(X, found);
    sink += minimum_norm_rates(chain, q, Twist::Ones(), 0.1, q, found) == SolveStatus::ok;
    sink += found[3];
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_TRUE(std::isfinite(sink));
}

}  // namespace
}  // namespace understudy::kinematics

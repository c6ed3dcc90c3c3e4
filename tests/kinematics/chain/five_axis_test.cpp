#include "kinematics/chain/five_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/rate_check.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr FiveAxisGeometry kOffset{from_mm(4), from_mm(-35), from_mm(-1.5), from_mm(2.5)};

void set_home(ChainDescription& d, const AxisVector& home) {
  d.home = home;
  d.slide_words = {{'X', 0, 1, home[0]}, {'Y', 1, 1, home[1]}, {'Z', 2, 1, home[2]}};
  d.turn_words = {{'B', 3, 1, home[3]}, {'C', 4, 1, home[4]}};
}

ChainDescription described(const FiveAxisGeometry& g, double b_max = kEndless) {
  ChainDescription d;
  d.kind = "five-axis";
  d.parameters = {g.b_axis_x, g.b_axis_z, g.c_axis_x, g.c_axis_y};
  d.chain = five_axis_chain(g);
  d.chain.axes[3].lower = -b_max;
  d.chain.axes[3].upper = b_max;
  set_home(d, {0, 0, 0.1, 0, 0});
  return d;
}

FiveAxes random_axes(Random& random, double c_max = 3 * kPi) {
  return {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0, 0.2),
          random.uniform(-kPi, kPi), random.uniform(-c_max, c_max)};
}

// docs/reference.md#five-axis-printer, written out: no rotation matrix of the code under test.
Vec3 tip_of_reference(const FiveAxes& q) {
  const double cb = std::cos(q[3]), sb = std::sin(q[3]), cc = std::cos(q[4]), sc = std::sin(q[4]);
  const double u = cb * q[0] + sb * q[2];
  return {cc * u - sc * q[1], sc * u + cc * q[1], -sb * q[0] + cb * q[2]};
}
Vec3 axis_of_reference(const FiveAxes& q) {
  return {std::sin(q[3]) * std::cos(q[4]), std::sin(q[3]) * std::sin(q[4]), std::cos(q[3])};
}

TEST(FiveAxis, ChainIsThatOfTheReferenceWithoutOffsets) {
  const Chain chain = five_axis_chain({});
  Random random(31, "five-axis");
  for (int n = 0; n < 2000; ++n) {
    const FiveAxes q = random_axes(random);
    const Pose X = forward(chain, q);
    // A few products of numbers below 1: some 1e-16 each.
    EXPECT_LE((X.translation() - tip_of_reference(q)).norm(), 1e-15) << n;
    EXPECT_LE((tool_axis(X) - axis_of_reference(q)).norm(), 2e-15) << n;
  }
}

// The tip, carried by the slides; then the table moved back about each of its own lines, in space.
TEST(FiveAxis, OffsetAxesTurnTheTableAboutTheirOwnLines) {
  const Chain chain = five_axis_chain(kOffset);
  Random random(32, "five-axis");
  for (int n = 0; n < 500; ++n) {
    const FiveAxes q = random_axes(random);
    const Eigen::Translation3d to_b(kOffset.b_axis_x, 0, kOffset.b_axis_z);
    const Eigen::Translation3d to_c(kOffset.c_axis_x, kOffset.c_axis_y, 0);
    const Eigen::Affine3d table = to_b * Eigen::AngleAxisd(-q[3], Vec3::UnitY()) * to_b.inverse() * to_c *
                                  Eigen::AngleAxisd(-q[4], Vec3::UnitZ()) * to_c.inverse();
    const Vec3 expected = table.inverse() * Vec3(q[0], q[1], q[2]);
    EXPECT_LE((forward(chain, q).translation() - expected).norm(), 2e-15) << n;
    EXPECT_LE((five_axis_pose(kOffset, q).matrix() - forward(chain, q).matrix()).norm(), 4e-15) << n;
  }
  // A point on the line of B stays where B leaves it.
  const Vec3 on_line(kOffset.b_axis_x, 0.02, kOffset.b_axis_z);
  EXPECT_LE((five_axis_pose(kOffset, {on_line.x(), on_line.y(), on_line.z(), 1.1, 0}).translation() - on_line)
                .norm(),
            1e-16);
}

void expect_round_trips(int poses, std::uint64_t seed) {
  Random random(seed, "five-axis round trip");
  for (const FiveAxisGeometry& g : {FiveAxisGeometry{}, kOffset}) {
    const ChainDescription d = described(g);
    const auto mechanism = make_chain_mechanism(d);
    double worst_tip = 0, worst_axis = 0;
    for (int n = 0; n < poses / 2; ++n) {
      const FiveAxes q = random_axes(random);
      const Pose X = forward(d.chain, q);
      FiveAxisBranches branches;
      ASSERT_EQ(five_axis_branches(g, X, 0, branches), SolveStatus::ok);
      for (const FiveAxes& branch : branches.axes) {
        const Pose X_back = forward(d.chain, branch);
        worst_tip = std::max(worst_tip, (X_back.translation() - X.translation()).norm());
        worst_axis = std::max(worst_axis, (tool_axis(X_back) - tool_axis(X)).norm());
      }
      EXPECT_NEAR(branches.axes[1][3], -branches.axes[0][3], 1e-15);
      EXPECT_NEAR(std::remainder(branches.axes[1][4] - branches.axes[0][4] - kPi, 2 * kPi), 0, 1e-14);
      FiveAxes found{};
      ASSERT_EQ(mechanism->inverse(X, q, found), SolveStatus::ok);
      for (std::size_t i = 0; i < kFiveAxes; ++i)
        EXPECT_NEAR(found[i], q[i], 1e-10) << "seed " << seed << " pose " << n << " axis " << i;
      if (::testing::Test::HasFailure()) return;
    }
    EXPECT_LE(worst_tip, 6e-14);  // docs/reference.md#five-axis-printer: over 20 000 poses
    EXPECT_LE(worst_axis, 6e-14);
  }
}

TEST(FiveAxis, BothBranchesReachThePoseAndThePreviousOneIsKept) { expect_round_trips(5'000, 33); }
TEST(SlowFiveAxis, BothBranchesReachThePoseAndThePreviousOneIsKept) { expect_round_trips(100'000, 34); }

void expect_rates_of_differences(int poses, std::uint64_t seed) {
  Random random(seed, "five-axis rates");
  const ChainDescription d = described(kOffset);
  const auto mechanism = make_chain_mechanism(d);
  for (int n = 0; n < poses; ++n) {
    FiveAxes q = random_axes(random);
    q[3] = (random.uniform() < 0.5 ? -1 : 1) * random.uniform(0.2, kPi - 0.2);  // C turns nothing upright
    EXPECT_LE(worst_rate_difference(*mechanism, forward(d.chain, q), q), 1e-7) << seed << " pose " << n;
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(FiveAxis, RatesAreTheDerivativesOfTheInverse) { expect_rates_of_differences(1'000, 35); }
TEST(SlowFiveAxis, RatesAreTheDerivativesOfTheInverse) { expect_rates_of_differences(100'000, 36); }

TEST(FiveAxis, TurnsUnwindWithoutLimitAlongAHelix) {
  const auto mechanism = make_chain_mechanism(described(kOffset));
  FiveAxes q{};
  for (int n = 0; n <= 20'000; ++n) {  // 50 turns of the tool's axis about the vertical
    const double turn = n * 2 * kPi / 400;
    const Pose X = five_axis_tip_pose({0.02, 0.01, 1e-6 * n}, 0.4, turn);
    const FiveAxes before = q;
    ASSERT_EQ(mechanism->inverse(X, n == 0 ? std::span<const double>() : before, q), SolveStatus::ok);
    if (n == 0) continue;
    ASSERT_NEAR(q[4] - before[4], 2 * kPi / 400, 1e-9) << n;
    ASSERT_NEAR(q[3], 0.4, 1e-12);
  }
  EXPECT_NEAR(q[4], 100 * kPi, 1e-9);
}

TEST(FiveAxis, UprightToolKeepsThePreviousTurn) {
  const auto mechanism = make_chain_mechanism(described({}));
  const FiveAxes previous{0, 0, 0, 0.3, 17.3};
  FiveAxes q{};
  ASSERT_EQ(mechanism->inverse(make_pose(Mat3(Mat3::Identity()), Vec3(0.01, 0.02, 0.03)), previous, q),
            SolveStatus::ok);
  EXPECT_EQ(q[4], 17.3);
  EXPECT_EQ(q[3], 0);
  EXPECT_LE((tip_of_reference(q) - Vec3(0.01, 0.02, 0.03)).norm(), 1e-16);
}

TEST(FiveAxis, TheBranchWithinRangesWinsOverTheNearerOne) {
  ChainDescription d = described({});
  d.chain.axes[3].lower = -0.1;
  d.chain.axes[3].upper = 1.5;
  const auto mechanism = make_chain_mechanism(d);
  const Pose X = five_axis_tip_pose({0, 0, 0.05}, 0.8, 0.2);
  const FiveAxes near_the_other{0, 0, 0.05, -0.8, 0.1 + kPi};
  FiveAxes q{};
  ASSERT_EQ(mechanism->inverse(X, near_the_other, q), SolveStatus::ok);
  EXPECT_NEAR(q[3], 0.8, 1e-14);
  EXPECT_NEAR(q[4], 0.2, 1e-14);
}

TEST(FiveAxis, ProgramWordsAreAxesOrTipAsTheSwitchSays) {
  Random random(37, "words");
  for (int n = 0; n < 2000; ++n) {
    const FiveAxes words = random_axes(random);
    const Vec3 tip(words[0], words[1], words[2]);
    EXPECT_EQ(five_axis_tip_pose(tip, words[3], words[4]).translation(), tip);
    const FiveAxes axes = five_axis_at_tip(kOffset, tip, words[3], words[4]);
    EXPECT_EQ(axes[3], words[3]);
    EXPECT_EQ(axes[4], words[4]);
    const Pose X = five_axis_pose(kOffset, axes);
    EXPECT_LE((X.matrix() - five_axis_tip_pose(tip, words[3], words[4]).matrix()).norm(), 6e-14);
  }
  // Off, by hand: with B at 90 degrees a slide in z moves the tip along the work's x.
  const Pose X = five_axis_pose({}, {0, 0, 0.1, kPi / 2, 0});
  EXPECT_LE((X.translation() - Vec3(0.1, 0, 0)).norm(), 1e-16);
}

TEST(FiveAxis, RotaryWordsAreWhatTheMechanismReadsThemAs) {
  ChainDescription d = described(kOffset);
  set_home(d, {0, 0, 0.1, 0.2, -0.3});
  const auto mechanism = make_chain_mechanism(d);
  const auto words = mechanism->rotary_words();
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0].letter, 'B');
  EXPECT_EQ(words[1].letter, 'C');
  EXPECT_EQ(words[0].home, 0.2);
  EXPECT_EQ(words[1].home, -0.3);
  Random random(38, "five-axis");
  for (int n = 0; n < 500; ++n) {
    const FiveAxes q = random_axes(random);
    const RotaryTarget slides{{q[0], q[1], q[2]}, words[0].reading(q), words[1].reading(q)};
    Pose by_axes, by_slides, by_tip;
    ASSERT_EQ(mechanism->forward(q, mechanism->home(), by_axes), SolveStatus::ok);
    ASSERT_EQ(mechanism->pose_at_slides(slides, by_slides), SolveStatus::ok);
    const RotaryTarget tip{by_slides.translation(), slides.b, slides.c};
    ASSERT_EQ(mechanism->pose_at_turns(tip, by_tip), SolveStatus::ok);
    Vec3 back;
    ASSERT_EQ(mechanism->slides_at_turns(tip, back), SolveStatus::ok);
    EXPECT_LE((by_slides.matrix() - by_axes.matrix()).norm(), 4e-15) << n;
    EXPECT_LE((by_tip.matrix() - by_axes.matrix()).norm(), 4e-15) << n;
    EXPECT_LE((back - slides.p_BT).norm(), 1e-15) << n;
  }
}

TEST(FiveAxis, UprightIsSingularAndRatesStayFinite) {
  const auto mechanism = make_chain_mechanism(described(kOffset));
  const FiveAxes q{0.01, 0.02, 0.03, 0, 0.5};
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(5, 6);
  EXPECT_EQ(mechanism->axis_rates(five_axis_pose(kOffset, q), q, rates), SolveStatus::singular);
  EXPECT_TRUE(rates.allFinite());
  EXPECT_EQ(mechanism->condition_number(five_axis_pose(kOffset, q), q), kSingularCondition);
  EXPECT_FALSE(mechanism->follows_spin());
}

TEST(FiveAxis, BadInputIsNamedAndLeavesTheAxesAlone) {
  const auto mechanism = make_chain_mechanism(described(kOffset));
  const FiveAxes kept{1, 2, 3, 4, 5};
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    FiveAxes q = kept;
    Pose X = Pose::Identity();
    X.translation().y() = bad;
    EXPECT_EQ(mechanism->inverse(X, {}, q), SolveStatus::bad_input);
    X = Pose::Identity();
    X.linear()(0, 0) = bad;
    EXPECT_EQ(mechanism->inverse(X, {}, q), SolveStatus::bad_input);
    FiveAxes previous{};
    previous[4] = bad;
    EXPECT_EQ(mechanism->inverse(Pose::Identity(), previous, q), SolveStatus::bad_input);
    EXPECT_EQ(q, kept);
    EXPECT_EQ(mechanism->forward(previous, Pose::Identity(), X), SolveStatus::bad_input);
    EXPECT_EQ(mechanism->condition_number(Pose::Identity(), previous), kSingularCondition);
  }
  FiveAxes q = kept;
  Pose X = Pose::Identity();
  X.linear() *= 1.01;
  EXPECT_EQ(mechanism->inverse(X, {}, q), SolveStatus::bad_input);
  EXPECT_EQ(mechanism->inverse(Pose::Identity(), {}, std::span<double>(q.data(), 4)), SolveStatus::bad_input);
  EXPECT_EQ(q, kept);
}

TEST(FiveAxis, NothingAllocates) {
  const auto mechanism = make_chain_mechanism(described(kOffset));
  Random random(38, "allocation");
  double sink = 0;
  const long before = allocations();
  for (int n = 0; n < 100; ++n) {
    FiveAxes q = random_axes(random), found{};
    Pose X = Pose::Identity();
    Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxAxes, 6> rates(kFiveAxes, 6);
    sink += mechanism->forward(q, X, X) == SolveStatus::ok;
    sink += mechanism->inverse(X, q, found) == SolveStatus::ok;
    sink += mechanism->axis_rates(X, found, rates) == SolveStatus::ok;
    sink += found[0] + rates(0, 0) + mechanism->condition_number(X, found) + five_axis_pose(kOffset, q)(0, 3);
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_TRUE(std::isfinite(sink));
}

}  // namespace
}  // namespace understudy::kinematics

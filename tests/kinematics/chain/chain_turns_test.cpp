// Words of programs on chains that their files describe. Expected values are the closed form of the five-axis
// printer, rotations written out, forward kinematics, and central differences.
#include "kinematics/chain/chain_turns.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/five_axis.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::kinematics {
namespace {

using testing::HasSubstr;

constexpr double kRounding = 2e-15;  // some sums and products of numbers below 1
constexpr FiveAxisGeometry kOffset{from_mm(4), from_mm(-35), from_mm(-1.5), from_mm(2.5)};

Mat3 turn(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

AxisWord word(char letter, std::size_t axis, int sign = 1, double zero = 0) {
  return {letter, axis, sign, -sign * zero, zero};  // of axes whose home is 0
}

ChainDescription table_machine() {
  ChainDescription d;
  d.kind = "chain";
  d.chain = five_axis_chain(kOffset);
  d.slide_words = {word('X', 0), word('Y', 1), word('Z', 2)};
  d.turn_words = {word('B', 3), word('C', 4)};
  return d;
}

/// x y z carry a head that leans about x (a), 60 mm above the tip, over a table that turns about z (c).
ChainDescription head_machine() {
  ChainDescription d;
  d.kind = "chain";
  d.chain.axes = {sliding_axis("x", Vec3::UnitX(), -1), sliding_axis("y", Vec3::UnitY(), 0),
                  sliding_axis("z", Vec3::UnitZ(), 1), turning_axis("a", Vec3::UnitX(), Vec3(0, 0, 0.06), 2),
                  turning_axis("c", Vec3::UnitZ(), Vec3::Zero(), -1)};
  d.chain.tool_axis = 3;
  d.chain.work_axis = 4;
  d.slide_words = {word('X', 0), word('Y', 1), word('Z', 2)};
  d.turn_words = {word('A', 3), word('C', 4)};
  return d;
}

/// An arm of six axes, tool downwards, beside a table that tilts about x and turns about z.
ChainDescription arm_machine() {
  ChainDescription d;
  d.kind = "chain";
  const Vec3 foot(-0.6, 0, -0.2);
  d.chain.axes = {turning_axis("j1", Vec3::UnitZ(), foot, -1),
                  turning_axis("j2", Vec3::UnitY(), foot + Vec3(0, 0, 0.3), 0),
                  turning_axis("j3", Vec3::UnitY(), foot + Vec3(0, 0, 0.8), 1),
                  turning_axis("j4", Vec3::UnitX(), foot + Vec3(0, 0, 0.8), 2),
                  turning_axis("j5", Vec3::UnitY(), foot + Vec3(0.5, 0, 0.8), 3),
                  turning_axis("j6", Vec3::UnitX(), foot + Vec3(0.5, 0, 0.8), 4),
                  turning_axis("tilt", Vec3::UnitX(), Vec3(0, 0, -0.1), -1),
                  turning_axis("turn", Vec3::UnitZ(), Vec3::Zero(), 6)};
  d.chain.tool_axis = 5;
  d.chain.work_axis = 7;
  d.chain.X_OT_zero = make_pose(Quat(turn(Vec3::UnitY(), -from_deg(90))), Vec3(foot + Vec3(0.6, 0, 0.8)));
  d.home = {0, 0.35, 0.25, 0, from_deg(90) - 0.6, 0, 0, 0};
  d.turn_words = {word('A', 6), word('C', 7)};
  return d;
}

RotaryTarget random_target(Random& random, double reach = 0.05) {
  return {{random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(0, reach)},
          random.uniform(-0.6, 0.6),
          random.uniform(-4, 4)};
}

TEST(ChainTurns, AreThoseOfTheClosedFormWhereThatHasOne) {
  const auto mechanism = make_chain_mechanism(table_machine());
  Random random(51, "chain turns");
  for (int n = 0; n < 1000; ++n) {
    const RotaryTarget at = random_target(random);
    Pose X;
    ASSERT_EQ(mechanism->pose_at_turns(at, X), SolveStatus::ok);
    EXPECT_LE((X.matrix() - five_axis_tip_pose(at.p_BT, at.b, at.c).matrix()).norm(), kRounding);
    ASSERT_EQ(mechanism->pose_at_slides(at, X), SolveStatus::ok);
    const FiveAxes axes{at.p_BT.x(), at.p_BT.y(), at.p_BT.z(), at.b, at.c};
    EXPECT_LE((X.matrix() - five_axis_pose(kOffset, axes).matrix()).norm(), kRounding);
    Vec3 slides;
    ASSERT_EQ(mechanism->slides_at_turns(at, slides), SolveStatus::ok);
    const FiveAxes expected = five_axis_at_tip(kOffset, at.p_BT, at.b, at.c);
    EXPECT_LE((slides - Vec3(expected[0], expected[1], expected[2])).norm(), kRounding);
  }
}

TEST(ChainTurns, CountAsTheirSignAndZeroSay) {
  ChainDescription d = table_machine();
  d.turn_words = {word('A', 4, -1, 0.3), word('V', 3, 1, -0.2)};  // the turn first
  d.slide_words[0] = word('X', 0, -1, 0.01);
  const auto mechanism = make_chain_mechanism(d);
  EXPECT_EQ(mechanism->rotary_words()[0].letter, 'A');
  EXPECT_DOUBLE_EQ(mechanism->rotary_words()[0].home, 0.3);  // the axis at 0 is 0.3 below the word's 0
  Pose X;
  ASSERT_EQ(mechanism->pose_at_turns({Vec3(0.01, 0, 0), 0.5, 0.1}, X), SolveStatus::ok);
  // The turn stands at 0.3 - 0.5, the tilt at -0.2 + 0.1.
  EXPECT_LE((X.matrix() - five_axis_tip_pose(Vec3(0.01, 0, 0), -0.1, -0.2).matrix()).norm(), kRounding);
  ASSERT_EQ(mechanism->pose_at_slides({Vec3(0.02, 0, 0), 0.3, 0.2}, X), SolveStatus::ok);
  EXPECT_LE((X.translation() - Vec3(-0.01, 0, 0)).norm(), kRounding);
  Vec3 slides;
  ASSERT_EQ(mechanism->slides_at_turns({Vec3(-0.01, 0, 0), 0.3, 0.2}, slides), SolveStatus::ok);
  EXPECT_LE((slides - Vec3(0.02, 0, 0)).norm(), kRounding);
}

TEST(ChainTurns, ATiltOfTheHeadTurnsTheToolAndOneOfTheTableTheWork) {
  const auto mechanism = make_chain_mechanism(head_machine());
  Random random(52, "chain turns");
  for (int n = 0; n < 1000; ++n) {
    const RotaryTarget at = random_target(random);
    const Mat3 table = turn(Vec3::UnitZ(), -at.c), head = turn(Vec3::UnitX(), at.b);
    Pose X;
    ASSERT_EQ(mechanism->pose_at_slides(at, X), SolveStatus::ok);
    // The head's axis is 60 mm above the tip.
    const Vec3 arm(0, 0, -0.06);
    EXPECT_LE((X.translation() - table * (at.p_BT - arm + head * arm)).norm(), kRounding);
    EXPECT_LE((X.linear() - table * head).norm(), kRounding);
    Mat3 table_part, head_part;
    ASSERT_EQ(mechanism->parts_at_turns(at, table_part, head_part), SolveStatus::ok);
    EXPECT_LE((table_part - table).norm() + (head_part - head).norm(), kRounding);
  }
}

/// The axes hold the tip, the words their readings, and rates are central differences.
void expect_followed(const ChainDescription& d, const RotaryTarget& at, const RotaryTarget& rate,
                     double rounding, double rounding_of_rates) {
  const auto mechanism = make_chain_mechanism(d);
  AxisVector axes = d.home, rates{}, unused{};
  ASSERT_EQ(mechanism->axes_at_turns(at, rate, axes, rates), SolveStatus::ok);
  EXPECT_DOUBLE_EQ(d.turn_words[0].reading(axes), at.b);
  Pose X, expected;
  ASSERT_EQ(mechanism->forward(axes, X, X), SolveStatus::ok);
  ASSERT_EQ(mechanism->pose_at_turns(at, expected), SolveStatus::ok);
  EXPECT_LE((X.translation() - at.p_BT).norm(), rounding);
  EXPECT_LE((X.matrix() - expected.matrix()).norm(), rounding);
  constexpr double h = 1e-5;
  AxisVector ahead = axes, behind = axes;
  const auto moved = [&](double s) {
    return RotaryTarget{at.p_BT + s * rate.p_BT, at.b + s * rate.b, at.c + s * rate.c};
  };
  ASSERT_EQ(mechanism->axes_at_turns(moved(h), rate, ahead, unused), SolveStatus::ok);
  ASSERT_EQ(mechanism->axes_at_turns(moved(-h), rate, behind, unused), SolveStatus::ok);
  for (std::size_t i = 0; i < d.chain.axes.size(); ++i)
    EXPECT_NEAR(rates[i], (ahead[i] - behind[i]) / (2 * h), rounding_of_rates) << d.chain.axes[i].name;
}

TEST(ChainTurns, SlidesFollowTheTip) {
  Random random(53, "chain turns");
  for (int n = 0; n < 100; ++n) {
    const RotaryTarget at = random_target(random), rate = random_target(random);
    // Truncation h^2 times a third derivative of 1, rounding 1e-15 / h.
    for (ChainDescription d : {table_machine(), head_machine()})
      for (const int sign : {1, -1}) {
        d.turn_words[0].sign = sign;
        expect_followed(d, at, rate, kRounding, 2e-9);
      }
  }
}

TEST(ChainTurns, OneWordIsEnough) {
  ChainDescription d = head_machine();
  d.chain.axes.pop_back();
  d.chain.work_axis = -1;
  d.turn_words.pop_back();
  ASSERT_EQ(turns_problem(d), "");
  expect_followed(d, {{0.01, 0.02, 0.03}, 0.4, 0}, {{0.1, 0.2, 0}, 1, 0}, kRounding, 2e-9);
}

TEST(ChainTurns, AnArmHoldsItsToolOverTheTableThatTurns) {
  const ChainDescription d = arm_machine();
  ASSERT_EQ(turns_problem(d), "");
  const auto mechanism = make_chain_mechanism(d);
  Random random(54, "chain turns");
  for (int n = 0; n < 30; ++n) {
    const RotaryTarget at = random_target(random), rate = random_target(random);
    expect_followed(d, at, rate, 4e-12, 1e-6);  // of a numeric inverse: 1e-12 m, over h
    // By hand: the tool stays upright in space, so the work sees it turned back by tilt and turn.
    Pose X;
    ASSERT_EQ(mechanism->pose_at_turns(at, X), SolveStatus::ok);
    const Vec3 seen = turn(Vec3::UnitZ(), -at.c) * turn(Vec3::UnitX(), -at.b) * Vec3::UnitZ();
    EXPECT_LE((tool_axis(X) - seen).norm(), kRounding) << n;
  }
  Vec3 slides;
  EXPECT_FALSE(mechanism->has_slide_words());
  EXPECT_EQ(mechanism->slides_at_turns({}, slides), SolveStatus::bad_input);
}

TEST(ChainTurns, WordsThatLeaveTheTipOpenAreRefused) {
  EXPECT_EQ(turns_problem(table_machine()), "");
  ChainDescription d = head_machine();
  d.turn_words.pop_back();  // x y z and c are left
  EXPECT_THAT(turns_problem(d), HasSubstr("axis a carries the tool, and the axes that no word drives"));
  d = table_machine();
  d.turn_words.pop_back();
  EXPECT_THAT(turns_problem(d), HasSubstr("axis c has no word and does not carry the tool alone"));
  d = table_machine();
  d.chain.axes[2].direction = Vec3(0.6, 0.8, 0);
  EXPECT_THAT(turns_problem(d), HasSubstr("lie in one plane"));
}

TEST(ChainTurns, WithoutWordsThereIsNoAnswer) {
  ChainDescription d = table_machine();
  d.turn_words.clear();
  const auto mechanism = make_chain_mechanism(d);
  Pose X;
  EXPECT_TRUE(mechanism->rotary_words().empty());
  EXPECT_EQ(mechanism->pose_at_turns({}, X), SolveStatus::bad_input);
  const auto with = make_chain_mechanism(table_machine());
  EXPECT_EQ(with->pose_at_turns({Vec3::Zero(), NAN, 0}, X), SolveStatus::bad_input);
  AxisVector axes{}, rates{};
  EXPECT_EQ(with->axes_at_turns({}, {Vec3::Zero(), 0, INFINITY}, axes, rates), SolveStatus::bad_input);
}

TEST(ChainTurns, NothingAllocates) {
  for (const ChainDescription& d : {table_machine(), arm_machine()}) {
    const auto mechanism = make_chain_mechanism(d);
    const RotaryTarget at{{0.01, 0.02, 0.03}, 0.1, 0.2}, rate{{0.1, 0, 0}, 1, 1};
    AxisVector axes = d.home, rates{};
    const long before = allocations();
    const SolveStatus status = mechanism->axes_at_turns(at, rate, axes, rates);
    EXPECT_EQ(allocations() - before, 0);
    EXPECT_EQ(status, SolveStatus::ok);
  }
}

}  // namespace
}  // namespace understudy::kinematics

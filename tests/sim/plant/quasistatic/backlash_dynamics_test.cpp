#include "sim/plant/quasistatic/backlash_dynamics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kPlay = 100e-6;     // [m]
constexpr double kTolerance = 1e-9;  // [m]: a nanometre; sums of some hundred steps are far better

/// One axis with a play on its far side.
BacklashDynamics one_axis(double friction = 0, double damping = 0) {
  BacklashDynamics plays(1);
  plays.set_play(0, {0, kPlay, friction, damping});
  return plays;
}

AxisMatrix mass_of(double kilograms) { return AxisMatrix::Constant(1, 1, kilograms); }
AxisLoad pushing(double newtons) { return {{newtons}, {}}; }

TEST(BacklashDynamics, RestsOnTheSideThatTheLoadPushesItTo) {
  const BacklashDynamics plays = one_axis();
  EXPECT_EQ(plays.resting_gap(0, pushing(1)), -kPlay / 2) << "the drive pushes: the link lags behind";
  EXPECT_EQ(plays.resting_gap(0, pushing(-1)), kPlay / 2);
  EXPECT_EQ(plays.resting_gap(0, pushing(0)), 0);
  EXPECT_FALSE(plays.rests(pushing(1)));
  EXPECT_TRUE(plays.rests(pushing(0)));
}

TEST(BacklashDynamics, FrictionHoldsAGapAgainstLessThanItself) {
  BacklashDynamics plays = one_axis(2);
  plays.place(0, 20e-6);
  EXPECT_TRUE(plays.rests(pushing(1.9)));
  EXPECT_TRUE(plays.rests(pushing(-1.9)));
  EXPECT_EQ(plays.resting_gap(0, pushing(2.1)), -kPlay / 2);
  EXPECT_NEAR(plays.advance(mass_of(1), pushing(1.9), 0.1)[0], 1.9, 1e-12) << "the drive carries what rests";
  EXPECT_EQ(plays.gap()[0], 20e-6);
}

TEST(BacklashDynamics, FallsAcrossItsPlayFreely) {
  BacklashDynamics plays = one_axis();
  plays.place(0, kPlay / 2);
  // 1 kg under 1 N: g = b/2 - t^2 / 2.
  for (int ms = 1; ms <= 10; ++ms) {
    const double force = plays.advance(mass_of(1), pushing(1), 1e-3)[0];
    EXPECT_NEAR(force, 0, 1e-6) << "nothing touches";
    const double t = 1e-3 * ms;
    EXPECT_NEAR(plays.gap()[0], kPlay / 2 - t * t / 2, kTolerance) << ms;
    EXPECT_NEAR(plays.rate()[0], -t, 1e-9);
  }
  plays.advance(mass_of(1), pushing(1), 10e-3);  // sqrt(2 b) = 14 ms in all
  EXPECT_EQ(plays.gap()[0], -kPlay / 2);
  EXPECT_EQ(plays.rate()[0], 0) << "nothing bounces";
  EXPECT_TRUE(plays.rests(pushing(1)));
}

TEST(BacklashDynamics, FromRestToRestTheDrivesGiveTheImpulseOfTheLoad) {
  BacklashDynamics plays = one_axis();
  plays.place(0, kPlay / 2);
  constexpr int kMilliseconds = 30;
  double impulse = 0;
  for (int ms = 0; ms < kMilliseconds; ++ms)
    impulse += 1e-3 * plays.advance(mass_of(0.7), pushing(2), 1e-3)[0];
  ASSERT_TRUE(plays.rests(pushing(2)));
  EXPECT_NEAR(impulse, 2 * 1e-3 * kMilliseconds, 1e-9);
}

TEST(BacklashDynamics, FrictionAndDampingSlowTheWayAcross) {
  BacklashDynamics rubbing = one_axis(0.25);
  rubbing.place(0, kPlay / 2);
  rubbing.advance(mass_of(1), pushing(1), 8e-3);
  EXPECT_NEAR(rubbing.rate()[0], -0.75 * 8e-3, 1e-9) << "1 N less 0.25 N moves 1 kg";
  BacklashDynamics damped = one_axis(0, 100);
  damped.place(0, kPlay / 2);
  damped.advance(mass_of(1e-3), pushing(1), 5e-3);  // settles within m / c = 10 us
  EXPECT_NEAR(damped.rate()[0], -0.01, 1e-6) << "load over damping";
}

TEST(BacklashDynamics, ANutThatWeighsKeepsItsOwnPlayShut) {
  BacklashDynamics plays(1);
  plays.set_play(0, {40e-6, 20e-6, 0, 0});
  const auto resting = [&](double carried) { return plays.resting_gap(0, {{carried + 2}, {2}}); };
  // The nut, pushed with 2 N, leans back on the drive: -20 um of its 40. What it carries has its own 20 um.
  EXPECT_DOUBLE_EQ(resting(1), -30e-6) << "both plays are pushed shut";
  EXPECT_DOUBLE_EQ(resting(-1), -20e-6 + 10e-6) << "1 N of pull takes the outer play alone";
  EXPECT_DOUBLE_EQ(resting(-3), 30e-6) << "3 N lift the nut as well";
}

TEST(BacklashDynamics, WhatIsPlacedStaysWithinThePlay) {
  BacklashDynamics plays = one_axis();
  plays.place(0, 1);
  EXPECT_EQ(plays.gap()[0], kPlay / 2);
  plays.set_play(0, {0, kPlay / 4, 0, 0});
  EXPECT_EQ(plays.gap()[0], kPlay / 8);
  plays.centre();
  EXPECT_EQ(plays.gap()[0], 0);
}

TEST(BacklashDynamics, GapsMoveTogetherWhereTheirMassesAreCoupled) {
  // One body of 1 kg on two axes, its centre between them: M = [1/2 1/2; 1/2 1/2] alone would leave the turn
  // free; a moment of inertia adds +-m. Under the same load on both the turn takes no part.
  BacklashDynamics plays(2);
  for (const int axis : {0, 1}) {
    plays.set_play(axis, {0, kPlay, 0, 0});
    plays.place(axis, kPlay / 2);
  }
  AxisMatrix mass(2, 2);
  mass << 0.75, 0.25, 0.25, 0.75;
  plays.advance(mass, {{1, 1}, {}}, 8e-3);
  EXPECT_NEAR(plays.rate()[0], -8e-3, 1e-12);
  EXPECT_NEAR(plays.rate()[1], -8e-3, 1e-12);
  // Pulled on one side alone, the other would be thrown ahead, against its stop.
  plays.centre();
  plays.place(0, kPlay / 2);
  plays.place(1, kPlay / 2);
  plays.advance(mass, {{1, 0}, {}}, 5e-3);
  EXPECT_NEAR(plays.rate()[0], -5e-3 / 0.75, 1e-12);
  EXPECT_EQ(plays.gap()[1], kPlay / 2);
}

}  // namespace
}  // namespace understudy::sim

// Gaps under way against closed forms, and against stops of stiff springs in steps of 0.1 us.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/plant/quasistatic/backlash_dynamics.h"

namespace understudy::sim {
namespace {

constexpr double kPlay = 100e-6;     // [m]
constexpr double kTolerance = 1e-9;  // [m]

BacklashDynamics one_axis(const SeriesPlay& play, double gap) {
  BacklashDynamics plays(1);
  plays.set_play(0, play);
  plays.place(0, gap);
  return plays;
}

AxisMatrix mass_of(double kilograms) { return AxisMatrix::Constant(1, 1, kilograms); }

TEST(BacklashFlight, DampingBringsAGapToItsTerminalSpeed) {
  const double c = 20, force = 0.1, time = 30e-3;
  BacklashDynamics plays = one_axis({0, 1e-3, 0, c}, 0.5e-3);
  plays.advance(mass_of(1), {{force}, {}}, time);
  EXPECT_NEAR(plays.rate()[0], -force / c * (1 - std::exp(-c * time)), 0.01 * force / c);
  // In steps of a plant the rule is a hundred times as near.
  plays.place(0, 0.5e-3);
  for (int k = 0; k < 15; ++k) plays.advance(mass_of(1), {{force}, {}}, 2e-3);
  EXPECT_NEAR(plays.rate()[0], -force / c * (1 - std::exp(-c * time)), 1e-4 * force / c);
  // That is (c h / m)^2 / 12 of how far it lags behind the terminal speed.
  EXPECT_NEAR(plays.gap()[0], 0.5e-3 - force / c * (time - (1 - std::exp(-c * time)) / c),
              1.4e-4 * force / (c * c));
}

TEST(BacklashFlight, TurnsRoundInTheMiddleOfAPlay) {
  BacklashDynamics plays = one_axis({0, kPlay, 0, 0}, kPlay / 2);
  plays.advance(mass_of(1), {{1}, {}}, 6e-3);    // to 18 um from the stop, at 6 mm/s
  plays.advance(mass_of(1), {{-1}, {}}, 20e-3);  // 18 um on, and back to the stop in 6 + sqrt(72) ms
  EXPECT_EQ(plays.gap()[0], kPlay / 2);
  EXPECT_EQ(plays.rate()[0], 0);
  plays.advance(mass_of(1), {{1}, {}}, 6e-3);
  plays.advance(mass_of(1), {{-1}, {}}, 10e-3);
  EXPECT_NEAR(plays.gap()[0], kPlay / 2 - 18e-6 - 60e-6 + 50e-6, kTolerance);
  EXPECT_NEAR(plays.rate()[0], -6e-3 + 10e-3, kTolerance);
}

TEST(BacklashFlight, FrictionStopsWhatNothingPushes) {
  BacklashDynamics plays = one_axis({0, kPlay, 0.25, 0}, kPlay / 2);
  plays.advance(mass_of(1), {{1}, {}}, 5e-3);  // 0.75 m/s^2
  const double speed = 0.75 * 5e-3, way = 0.5 * 0.75 * 5e-3 * 5e-3;
  plays.advance(mass_of(1), {{0}, {}}, 30e-3);
  EXPECT_NEAR(plays.gap()[0], kPlay / 2 - way - speed * speed / (2 * 0.25), kTolerance);
  EXPECT_EQ(plays.rate()[0], 0);
}

TEST(BacklashFlight, GoesOverALedgeWithAnotherForce) {
  // A nut of 2 N keeps its own 40 um shut. With a pull of 3 N the rod takes its 60 um freely of it, and lifts
  // it over the rest with the remaining newton.
  BacklashDynamics plays = one_axis({40e-6, 60e-6, 0, 0}, -kPlay / 2);
  const AxisLoad load{{-3 + 2}, {2}};
  const double first = std::sqrt(2 * 60e-6 / 3);
  plays.advance(mass_of(1), load, first);
  EXPECT_NEAR(plays.gap()[0], -kPlay / 2 + 60e-6, kTolerance);
  EXPECT_NEAR(plays.rate()[0], 3 * first, 1e-3 * 3 * first);
  const double then = 1.5e-3;  // one implicit step of 0.25 ms at the ledge is longer by half of it
  plays.advance(mass_of(1), load, then);
  EXPECT_NEAR(plays.gap()[0], -kPlay / 2 + 60e-6 + 3 * first * then + 0.5 * then * then,
              1 * 0.25e-3 * 0.25e-3);
}

/// Stops of 1e9 N/m, damped so that nothing bounces.
struct StiffStops {
  AxisMatrix inverse_mass;
  double gap[2] = {0, 0}, rate[2] = {0, 0};

  void advance(const AxisLoad& load, double duration) {
    constexpr double kStep = 0.1e-6, kStiffness = 1e9, kDamping = 2e5;
    for (double t = 0; t < duration - kStep / 2; t += kStep) {
      double force[2] = {0, 0};
      for (int i : {0, 1}) {
        const double in = std::abs(gap[i]) - kPlay / 2, side = gap[i] > 0 ? 1 : -1;
        const double push = in > 0 ? std::max(0.0, kStiffness * in + kDamping * side * rate[i]) : 0;
        force[i] = -side * push - load.drive[i];
      }
      for (int i : {0, 1}) rate[i] += kStep * (inverse_mass(i, 0) * force[0] + inverse_mass(i, 1) * force[1]);
      for (int i : {0, 1}) gap[i] += kStep * rate[i];
    }
  }
};

// Axes that throw and hold each other: how far one flies depends on when the others land and are lifted.
TEST(BacklashFlight, CoupledGapsGoAsBetweenStiffStops) {
  Random random(7, "coupled gaps");
  int crossings = 0;
  double worst = 0;
  for (int world = 0; world < 40; ++world) {
    const double a = random.uniform(0.2, 1), b = random.uniform(0.2, 1);
    AxisMatrix mass(2, 2);
    mass(0, 0) = a, mass(1, 1) = b;
    mass(0, 1) = mass(1, 0) = random.uniform(-0.8, 0.8) * std::sqrt(a * b);
    BacklashDynamics plays(2);
    StiffStops stops{mass.inverse(), {}};
    for (const int i : {0, 1}) {
      plays.set_play(i, {0, kPlay, 0, 0});
      plays.place(i, stops.gap[i] = i == 0 ? kPlay / 2 : -kPlay / 2);
    }
    for (int k = 0; k < 12; ++k) {
      AxisLoad load;
      for (const int i : {0, 1}) load.drive[i] = random.uniform(-1.5, 1.5);
      const double before = plays.gap()[0];
      plays.advance(mass, load, 2e-3);
      stops.advance(load, 2e-3);
      for (const int i : {0, 1}) worst = std::max(worst, std::abs(plays.gap()[i] - stops.gap[i]));
      crossings += before * plays.gap()[0] < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(crossings, 20);
  // Flights of less than 20 us end in an implicit step of 0.25 ms, which puts 1.5 N on 0.1 kg 0.5 um wrong:
  // some of them follow each other.
  EXPECT_LT(worst, 2e-6);
}

}  // namespace
}  // namespace understudy::sim

#include "sim/deposition/extruder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace understudy::sim {
namespace {

constexpr double kLag = 0.05;  // [s]

// dc/dt = v - c / lag from 0: out = v (t - lag (1 - exp(-t / lag))).
TEST(Extruder, FollowsAStepOfTheFeedAsAFirstOrderLag) {
  Extruder extruder(kLag);
  double out = 0;
  for (int k = 1; k <= 100; ++k) {
    const double t = 0.01 * k;
    out += extruder.advance(2e-3 * t, 0.01).filament;
    EXPECT_NEAR(out, 2e-3 * (t - kLag * (1 - std::exp(-t / kLag))), 1e-15) << t;
  }
  EXPECT_NEAR(extruder.column(), 2e-3 * kLag, 1e-9 * 2e-3) << "twenty lags later it is steady";
}

TEST(Extruder, TheAnswerDoesNotDependOnTheSteps) {
  Extruder once(kLag), often(kLag);
  const double whole = once.advance(1e-3, 0.4).filament;
  double parts = 0;
  for (int k = 1; k <= 400; ++k) parts += often.advance(1e-3 * k / 400, 1e-3).filament;
  EXPECT_NEAR(parts, whole, 1e-14);
}

TEST(Extruder, EverythingFedComesOutOrIsInTheColumn) {
  Random random(5, "extruder");
  for (const double lag : {0.0, 0.02, 0.3}) {
    Extruder extruder(lag);
    double fed = 0, out = 0;
    for (int k = 0; k < 5000; ++k) {
      fed += random.uniform(-0.4e-3, 0.5e-3);
      const auto flow = extruder.advance(fed, random.uniform(1e-3, 0.1));
      ASSERT_GE(flow.filament, 0);
      ASSERT_GE(flow.from, 0);
      ASSERT_LE(flow.from, 1);
      out += flow.filament;
      ASSERT_NEAR(fed, out + extruder.column(), 1e-12) << "lag " << lag << " step " << k;
    }
  }
}

TEST(Extruder, NothingFlowsBeforeARetractionIsMadeGood) {
  Extruder extruder(0);
  EXPECT_EQ(extruder.advance(-1e-3, 0.1).filament, 0);
  EXPECT_EQ(extruder.advance(-0.2e-3, 0.1).filament, 0);
  const auto flow = extruder.advance(0.6e-3, 0.1);
  EXPECT_NEAR(flow.filament, 0.6e-3, 1e-15);
  EXPECT_NEAR(flow.from, 0.25, 1e-12);
}

// With the feed stopped the column runs out with the lag; drawn back in time, it does not.
TEST(Extruder, ARetractionKeepsTheColumnIn) {
  Extruder stopped(kLag), drawn(kLag);
  for (Extruder* e : {&stopped, &drawn}) e->advance(10e-3, 10);
  const double waiting = stopped.column();
  EXPECT_NEAR(stopped.advance(10e-3, 20 * kLag).filament, waiting, 1e-8 * waiting);
  EXPECT_LT(drawn.advance(9e-3, 0.01).filament, 0.2 * waiting);
}

}  // namespace
}  // namespace understudy::sim

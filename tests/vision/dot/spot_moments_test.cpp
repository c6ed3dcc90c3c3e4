#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/vision/dot/synthetic_spot.h"
#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr int kSize = 80;

std::optional<Spot> moments_of(const SyntheticSpot& s, const Vec2& guess) {
  LightField light = flat_light(kSize, kSize, 20);
  add_spot(light, kSize, s);
  return measure_moments(quantise(light, kSize), {guess}, {});
}

TEST(SpotMoments, AreThoseOfTheGaussianThatTheSpotIs) {
  const auto spot = moments_of({Vec2(40.3, 38.8), 3, 2, 150}, Vec2(41, 38));
  ASSERT_TRUE(spot);
  EXPECT_TRUE(spot->converged);
  EXPECT_LE((spot->centre - Vec2(40.3, 38.8)).norm(), 0.01);
  // Integration over a pixel adds 1/12; rounding to 8 bits leaves 2 % of a second moment.
  EXPECT_NEAR(spot->spread(0, 0), 9 + 1.0 / 12, 0.2);
  EXPECT_NEAR(spot->spread(1, 1), 4 + 1.0 / 12, 0.1);
  EXPECT_NEAR(spot->spread(0, 1), 0, 0.05);
  EXPECT_NEAR(spot->flux / (2 * std::numbers::pi * 3 * 2 * 150), 1, 0.02);
  EXPECT_NEAR(spot->around.level, 20, 0.5);
}

TEST(SpotMoments, DoNotDependOnTheGuess) {
  const auto near = moments_of({Vec2(40.3, 38.8), 2.5, 2.5, 120}, Vec2(40, 39));
  const auto off = moments_of({Vec2(40.3, 38.8), 2.5, 2.5, 120}, Vec2(42, 37));
  ASSERT_TRUE(near && off);
  EXPECT_LE((near->centre - off->centre).norm(), 0.01);
}

TEST(SpotMoments, ThereAreNoneWhereTheWindowIsDarkerThanItsSurroundings) {
  EXPECT_FALSE(moments_of({Vec2(40, 40), 2.5, 2.5, -15}, Vec2(40, 40)));
}

TEST(SpotMoments, AWindowIsWhollyInsideWholeAndBeyondItsEdgeEmpty) {
  EXPECT_EQ(window_weight(1, 4, 3), 1);
  EXPECT_EQ(window_weight(5, 20, 3), 0);
  EXPECT_NEAR(window_weight(3, 12, 3), 0.5, 1e-12) << "half at its edge";
}

}  // namespace
}  // namespace understudy::vision

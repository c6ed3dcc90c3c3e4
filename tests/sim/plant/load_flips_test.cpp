#include "sim/plant/load_flips.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kStep = 2e-3;  // [s], between snapshots

LoadFlips flips_of(double seconds, double (*load)(double time)) {
  LoadFlips flips(2);
  for (int k = 0; k * kStep <= seconds; ++k) flips.add(k * kStep, {0, load(k * kStep), 100});
  return flips;
}

TEST(LoadFlips, ALoadThatSwingsFlipsTwiceAPeriod) {
  const auto flips = flips_of(3, [](double t) { return 2 * std::cos(2 * std::numbers::pi * t); });
  ASSERT_EQ(flips.count(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(flips.flips()[i].axis, 1);
    // 2 cos passes 0.5 on the far side asin(0.25) / 2 pi = 40 ms after its zero; the mean lags by half a
    // window.
    const double expected =
        0.25 + 0.5 * static_cast<double>(i) + std::asin(0.25) / (2 * std::numbers::pi) + 0.015;
    EXPECT_NEAR(flips.flips()[i].time, expected, 2 * kStep);
  }
}

TEST(LoadFlips, WhatStaysWithinHalfANewtonOrIsShortIsNone) {
  EXPECT_EQ(flips_of(1, [](double t) { return std::fmod(t, 0.2) < 0.1 ? 2. : -0.4; }).count(), 0u);
  // A blow of 4 ms, more than twice as strong as what the strut carries: its mean over 30 ms stays above
  // zero.
  EXPECT_EQ(flips_of(1, [](double t) { return std::fmod(t + 0.1, 0.2) < 3e-3 ? -5. : 2.; }).count(), 0u);
}

TEST(LoadFlips, OfVeryManyTheFirstAreKeptAndAllAreCounted) {
  const auto flips = flips_of(0.2 * 1500, [](double t) { return std::fmod(t, 0.2) < 0.1 ? 2. : -2.; });
  EXPECT_EQ(flips.flips().size(), LoadFlips::kMost);
  EXPECT_NEAR(static_cast<double>(flips.count()), 2 * 1500, 2);  // its ends
}

}  // namespace
}  // namespace understudy::sim

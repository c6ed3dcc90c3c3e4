#include "toolpath/arc_chords.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

constexpr double kPi = std::numbers::pi;

// The sagitta of a chord, r (1 - cos(chord / 2)), as 2 r sin^2(chord / 4), which keeps its digits on large
// circles.
TEST(ArcChords, TheLongestChordLiesTheToleranceInsideTheCircle) {
  for (const double radius : {1e-3, 0.1, 10., 1e4, 1e8}) {
    const double chord = chord_angle(radius, 2e-6);
    EXPECT_NEAR(2 * radius * std::pow(std::sin(chord / 4), 2), 2e-6, 2e-18 + 2e-6 * 1e-12) << radius;
  }
}

TEST(ArcChords, ASmallCircleHasSixteen) {
  for (const double radius : {0., 1e-9, 2e-6, 1e-5}) {
    EXPECT_DOUBLE_EQ(chord_angle(radius, 2e-6), kPi / 8) << radius;
    EXPECT_EQ(chord_count(2 * kPi, chord_angle(radius, 2e-6)), 16) << radius;
  }
}

TEST(ArcChords, TheyAreCountedBeyondEveryInteger) {
  EXPECT_EQ(chord_count(1e-9, kPi / 8), 1);
  EXPECT_EQ(chord_count(-kPi, kPi / 8), 8);
  EXPECT_NEAR(chord_count(1e12, 1e-6), 1e18, 1e6);
  EXPECT_FALSE((Chords{1e5, {}}.too_many()));
  EXPECT_TRUE((Chords{1e5 + 1, {}}.too_many()));
  EXPECT_TRUE((Chords{std::nan(""), {}}.too_many()));
}

}  // namespace
}  // namespace understudy::toolpath

#include "sim/deposition/bead_section.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kQuarterPi = std::numbers::pi / 4;

TEST(BeadSection, APressedBeadIsARectangleWithRoundedEdgesOfTheSameArea) {
  constexpr double kGap = 0.15e-3;
  for (const double width : {0.15e-3, 0.2e-3, 0.48e-3, 1.2e-3})
    EXPECT_NEAR(bead_width((width - kGap) * kGap + kQuarterPi * kGap * kGap, kGap), width, 1e-15);
}

TEST(BeadSection, ABeadTooThinToTouchBothSidesIsARoundStrand) {
  EXPECT_DOUBLE_EQ(bead_width(kQuarterPi * 0.1e-3 * 0.1e-3, 0.2e-3), 0.1e-3);
  EXPECT_DOUBLE_EQ(bead_width(kQuarterPi * 0.4e-3 * 0.4e-3, 0), 0.4e-3) << "no gap";
  EXPECT_DOUBLE_EQ(bead_width(kQuarterPi * 0.4e-3 * 0.4e-3, -0.1e-3), 0.4e-3) << "the tip is in the surface";
}

TEST(BeadSection, TurnsFromFlatToRoundWithoutAStep) {
  constexpr double kGap = 0.2e-3;
  const double touching = kQuarterPi * kGap * kGap;
  EXPECT_NEAR(bead_width(touching * (1 + 1e-12), kGap), kGap, 1e-12);
  EXPECT_NEAR(bead_width(touching * (1 - 1e-12), kGap), kGap, 1e-12);
  EXPECT_NEAR(bead_width(touching / 4, kGap), kGap / 2, 1e-15) << "a round strand of half the diameter";
}

TEST(BeadSection, TheHeightOfAWidthIsTheGapThatGivesThatWidth) {
  const double area = kQuarterPi * 0.48e-3 * 0.48e-3;
  for (const double gap : {0.1e-3, 0.15e-3, 0.3e-3, 0.45e-3})
    EXPECT_NEAR(bead_height(area, bead_width(area, gap)), gap, 1e-12);
  EXPECT_DOUBLE_EQ(bead_height(area, 0.3e-3), 0.48e-3) << "no narrower than round";
}

}  // namespace
}  // namespace understudy::sim

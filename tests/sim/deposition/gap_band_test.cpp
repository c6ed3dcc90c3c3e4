#include "sim/deposition/gap_band.h"

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

/// Song 2015: beads stick from 0.1 to 0.2 mm; aimed at 0.13 mm.
machine::GapLimits song() {
  machine::GapLimits limits;
  limits.accepted_min = 0.1e-3;
  limits.accepted_max = 0.2e-3;
  limits.aim = 0.13e-3;
  return limits;
}

TEST(GapBand, LayersAboutAsHighAsTheAimHaveTheBandOfTheMachine) {
  for (const double layer : {0.115e-3, 0.13e-3, 0.145e-3}) {
    const GapBand band = gap_band(song(), layer, 0.0585e-6);
    EXPECT_EQ(band.low, 0.1e-3);
    EXPECT_EQ(band.high, 0.2e-3);
    EXPECT_EQ(band.soft_depth, 0.1e-3);
  }
}

// 0.45 mm by 0.3 mm are 0.1157 mm2; a free strand of that is 0.3838 mm thick, 0.95 of it 0.3646 mm.
TEST(GapBand, ThreeTenthsAsSlicersPrintThem) {
  const GapBand band = gap_band(song(), 0.3e-3, 0.1157e-6);
  EXPECT_NEAR(band.low, 0.15e-3, 1e-12);
  EXPECT_NEAR(band.high, 0.3646e-3, 0.05e-6);
  EXPECT_NEAR(band.soft_depth, 0.15e-3, 1e-12) << "half a layer";
}

TEST(GapBand, LayersOfEightTenthsAreNotJudgedByTwo) {
  const GapBand band = gap_band(song(), 0.8e-3, 0.8227e-6);  // 1.2 mm wide
  EXPECT_NEAR(band.low, 0.4e-3, 1e-12);
  EXPECT_NEAR(band.high, 0.87e-3, 1e-12) << "0.07 mm above the layer, as 0.2 is above 0.13";
}

// A first layer of 0.18 mm by a machine whose tip is 0.05 mm off.
TEST(GapBand, ALayerSomewhatAboveTheAimMayBePressedAsLowAsTheMachineAllows) {
  EXPECT_EQ(gap_band(song(), 0.18e-3, 0.0814e-6).low, 0.1e-3);
}

TEST(GapBand, ThinLayersHaveANarrowerBand) {
  const GapBand band = gap_band(song(), 0.06e-3, 0.0262e-6);  // 0.45 mm wide
  EXPECT_NEAR(band.low, 0.046e-3, 0.2e-6);
  EXPECT_NEAR(band.high, 0.13e-3, 1e-9);
}

// 0.45 mm by 0.2 mm are 0.0814 mm2. Where the nozzle is 0.15 mm too high they hang: the free strand is 0.322
// mm.
TEST(GapBand, AFirstLayerThatIsPlannedTooHighDoesNotStick) {
  EXPECT_LT(gap_band(song(), 0.35e-3, 0.0814e-6).high, 0.35e-3);
  // The same of PrusaSlicer's first layer, 0.7 mm by 0.35 mm: 0.2187 mm2.
  EXPECT_GT(gap_band(song(), 0.35e-3, 0.2187e-6).high, 0.35e-3);
  EXPECT_LT(gap_band(song(), 0.50e-3, 0.2187e-6).high, 0.50e-3);
}

TEST(GapBand, NoLineIsJudgedMoreStrictlyThanByTheMachine) {
  EXPECT_EQ(gap_band(song(), 0.16e-3, 0.01e-6).high, 0.2e-3);
}

}  // namespace
}  // namespace understudy::sim

#include "sim/deposition/gap_sums.h"

#include <limits>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr GapBand kBand{0.1e-3, 0.2e-3};
constexpr double kRounding = 1e-5;  // of a ramp of 0.25 mm: a nanometre beside the band is in it

DepositionSummary summary_of(const GapSums& of) {
  DepositionSummary summary;
  of.fill(summary);
  return summary;
}

TEST(GapSums, ARampAcrossTheBandIsInItForItsShareOfTheLength) {
  GapSums s;
  s.add(0.05e-3, 0.3e-3, kBand, 10e-3, 1, 1);
  const DepositionSummary summary = summary_of(s);
  EXPECT_NEAR(summary.below_band_fraction, 0.2, kRounding);
  EXPECT_NEAR(summary.in_band_fraction, 0.4, kRounding);
  EXPECT_NEAR(summary.above_band_fraction, 0.4, kRounding);
  EXPECT_NEAR(summary.gap_mean, 0.175e-3, 1e-15);
}

TEST(GapSums, ARampCountsTheSameInPiecesAndBackwards) {
  GapSums whole, pieces;
  whole.add(0.05e-3, 0.3e-3, kBand, 10e-3, 1, 1);
  for (int i = 9; i >= 0; --i) pieces.add(0.05e-3 + 25e-6 * (i + 1), 0.05e-3 + 25e-6 * i, kBand, 1e-3, 1, 1);
  const DepositionSummary a = summary_of(whole), b = summary_of(pieces);
  EXPECT_NEAR(a.in_band_fraction, b.in_band_fraction, 1e-12);
  EXPECT_NEAR(a.below_band_fraction, b.below_band_fraction, 1e-12);
  EXPECT_NEAR(a.gap_mean, b.gap_mean, 1e-15);
}

TEST(GapSums, FractionsAreWeightedByLength) {
  GapSums s;
  s.add(0.15e-3, 0.15e-3, kBand, 3e-3, 1, 1);
  s.add(0.5e-3, 0.5e-3, kBand, 1e-3, 2, 2);
  const DepositionSummary summary = summary_of(s);
  EXPECT_NEAR(summary.length, 4e-3, 1e-18);
  EXPECT_NEAR(summary.in_band_fraction, 0.75, 1e-12);
  EXPECT_NEAR(summary.gap_mean, (3 * 0.15e-3 + 0.5e-3) / 4, 1e-15);
}

// Found by a scenario: a level line 0.06 mm too low was told on the travel behind it.
TEST(GapSums, OfEqualsButForRoundingTheFirstIsTheLowest) {
  GapSums s;
  for (int line = 7; line <= 9; ++line)
    s.add(0.04e-3 - 1e-13 * line, 0.04e-3 - 1e-13 * line, kBand, 1e-3, line, line);
  EXPECT_EQ(summary_of(s).lowest.line, 7);
  s.add(0.04e-3, 0.038e-3, kBand, 1e-3, 10, 10);
  EXPECT_EQ(summary_of(s).lowest.line, 10) << "2 um lower is lower";
}

TEST(GapSums, TheSmallestGapIsReportedWithItsTimeAndLine) {
  GapSums s;
  s.add(0.15e-3, 0.12e-3, kBand, 1e-3, 1, 11);
  s.add(0.12e-3, 0.18e-3, kBand, 1e-3, 2, 12);
  s.add(0.18e-3, 0.08e-3, kBand, 1e-3, 3, 13);
  s.add(0.08e-3, 0.16e-3, kBand, 1e-3, 4, 14);
  const DepositionSummary summary = summary_of(s);
  EXPECT_EQ(summary.gap_min, 0.08e-3);
  EXPECT_EQ(summary.gap_max, 0.18e-3);
  EXPECT_EQ(summary.gap_min_line, 13) << "the first of equals";
  EXPECT_EQ(summary.gap_min_time, 3);
}

TEST(GapSums, PathOverNothingIsAboveTheBandButInNoMean) {
  GapSums s;
  s.add(0.15e-3, 0.15e-3, kBand, 1e-3, 1, 1);
  s.add(kInfinity, kInfinity, kBand, 1e-3, 2, 2);
  const DepositionSummary summary = summary_of(s);
  EXPECT_EQ(summary.above_band_fraction, 0.5);
  EXPECT_DOUBLE_EQ(summary.gap_mean, 0.15e-3);
  EXPECT_EQ(summary.gap_max, 0.15e-3);
}

TEST(GapSums, WithoutPathThereAreNoFigures) {
  GapSums s;
  s.add(0.01e-3, 0.01e-3, kBand, 0, 1, 1);
  const DepositionSummary summary = summary_of(s);
  EXPECT_EQ(summary.length, 0);
  EXPECT_EQ(summary.in_band_fraction, 0);
  EXPECT_EQ(summary.gap_min, 0);
}

}  // namespace
}  // namespace understudy::sim

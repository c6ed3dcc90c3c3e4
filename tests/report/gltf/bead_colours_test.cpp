#include "report/gltf/bead_colours.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::report {
namespace {

using testing::ElementsAre;

/// The gap rises from 0 at 0 s to 1 mm at 10 s; nothing is below from 20 s on.
RecordedReplay replay() {
  RecordedReplay result;
  result.path.resize(4);
  const double times[] = {0, 10, 19.9, 20}, gaps[] = {0, 1e-3, 1e-3, std::nan("")};
  for (std::size_t i = 0; i < 4; ++i) {
    result.path[i].time = times[i];
    result.path[i].gap = gaps[i];
  }
  result.gap_band = GapBand{0.1e-3, 0.3e-3};
  for (int i = 0; i < 1000; ++i)
    result.beads.push_back({{Vec3::Zero(), Vec3::UnitZ(), 0.4e-3, 0.2e-3, 0, 1}});
  return result;
}

sim::BeadSection laid(double time, double width = 0.4e-3) {
  return {Vec3::Zero(), Vec3::UnitZ(), width, 0.2e-3, time, 1};
}

// sRGB 214, 214, 206 is 0.672, 0.672, 0.617 of linear light; 128 is 0.216; 0, 84, 148 is 0, 0.089, 0.296.
TEST(BeadColours, TheGapIsGreyInItsBandBlueBelowAndBrownAbove) {
  const RecordedReplay record = replay();
  const BeadColours colours(record, BeadColour::gap);
  EXPECT_THAT(colours.at(laid(2)), ElementsAre(171, 171, 157, 255));
  const auto low = colours.at(laid(0.5)), high = colours.at(laid(9));
  EXPECT_GT(low[2], 2 * low[0]);
  EXPECT_GT(high[0], 2 * high[2]);
  EXPECT_THAT(colours.at(laid(25)), ElementsAre(55, 55, 55, 255)) << "nothing below";
  EXPECT_EQ(colours.legend(), "gap, grey 0.10 to 0.30 mm, blue below, brown above");
}

TEST(BeadColours, TheWidthGoesFromDarkBlueToYellow) {
  const RecordedReplay record = replay();
  const BeadColours colours(record, BeadColour::width);
  EXPECT_EQ(colours.legend(), "width, dark blue 0 mm to yellow 0.400 mm");
  EXPECT_THAT(colours.at(laid(0, 0)), ElementsAre(0, 4, 19, 255)) << "sRGB 0, 34, 78";
  EXPECT_THAT(colours.at(laid(0, 0.4e-3)), ElementsAre(253, 206, 10, 255)) << "sRGB 254, 232, 56";
  EXPECT_EQ(colours.at(laid(0, 0.9e-3)), colours.at(laid(0, 0.4e-3))) << "the scale ends";
}

TEST(BeadColours, WhatCannotBeShownIsRefused) {
  RecordedReplay record = replay();
  record.gap_band.reset();
  EXPECT_THROW(BeadColours(record, BeadColour::gap), InputError);
  EXPECT_NO_THROW(BeadColours(record, BeadColour::width));
  EXPECT_EQ(bead_colour_of("width"), BeadColour::width);
  EXPECT_THROW(bead_colour_of("green"), InputError);
}

}  // namespace
}  // namespace understudy::report

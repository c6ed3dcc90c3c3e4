#include "rehearsal/inspection/place_on_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;

/// corexy's table reaches from -60 to 60 mm.
std::array<double, 3> placed(const Vec3& lower_mm, const Vec3& upper_mm, bool lowered) {
  static const auto machine = machine::load_machine("corexy");
  const toolpath::Extent printed{1e-3 * lower_mm, 1e-3 * upper_mm};
  return place_on_table(printed, printed, machine, 0.2e-3, lowered);
}

TEST(PlaceOnTable, WhatLiesWellStays) {
  EXPECT_THAT(placed({-10, -60, 0.2}, {10, 60, 30}, true), ElementsAre(0, 0, 0));
}

TEST(PlaceOnTable, WhatLeavesTheTableGoesToItsMiddle) {
  EXPECT_THAT(placed({50, 10, 0.2}, {70, 20, 30}, true), ElementsAre(-60, -15, 0));
  EXPECT_THAT(placed({-10, -100, 0.2}, {10, -80, 30}, true), ElementsAre(0, 90, 0));
}

TEST(PlaceOnTable, ThePartGoesThereWhateverIsPurgedBesideIt) {
  const auto machine = machine::load_machine("corexy");
  const toolpath::Extent printed{{0, -0.002, 0.0002}, {0.120, 0.100, 0.03}},
      part{{0.08, 0.08, 0.0003}, {0.12, 0.1, 0.03}};
  EXPECT_THAT(place_on_table(printed, part, machine, 0.2e-3, false), ElementsAre(-100, -90, 0));
}

TEST(PlaceOnTable, WhatIsBelowTheTableIsRaisedAndWhatIsFarAboveLoweredIfAsked) {
  EXPECT_THAT(placed({0, 0, -5}, {10, 10, 3}, false), ElementsAre(0, 0, 5.2));
  EXPECT_THAT(placed({0, 0, 12.5}, {10, 10, 30}, false), ElementsAre(0, 0, 0));
  EXPECT_THAT(placed({0, 0, 12.5}, {10, 10, 30}, true), ElementsAre(0, 0, -12.3));
}

}  // namespace
}  // namespace understudy::rehearsal

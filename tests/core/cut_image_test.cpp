#include "core/cut_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy {
namespace {

using ::testing::ElementsAre;

TEST(CutImage, HasItsPlaceOnTheSensorAndIsClipped) {
  const Image whole{{10, 20, 3, 2}, {0, 1, 2, 3, 4, 5}};
  const Image part = cut(whole, {11, 20, 1, 2});
  EXPECT_EQ(part.region, (Region{11, 20, 1, 2}));
  EXPECT_THAT(part.pixels, ElementsAre(1, 4));
  const Image corner = cut(whole, {-5, -5, 17, 26});
  EXPECT_EQ(corner.region, (Region{10, 20, 2, 1}));
  EXPECT_THAT(corner.pixels, ElementsAre(0, 1));
  EXPECT_TRUE(cut(whole, {100, 0, 5, 5}).pixels.empty());
}

}  // namespace
}  // namespace understudy

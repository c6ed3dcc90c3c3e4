#include "vision/dot/grey_levels.h"

#include <gtest/gtest.h>

namespace understudy::vision {
namespace {

Image picture(int width, int height, std::uint8_t level) {
  return {{0, 0, width, height}, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), level)};
}

TEST(GreyLevels, OfAPlainPictureAreItsLevel) {
  const GreyLevels g = grey_levels(picture(10, 10, 77));
  EXPECT_EQ(g.dark, 77);
  EXPECT_EQ(g.bright, 77);
  EXPECT_EQ(g.saturated_fraction, 0);
}

TEST(GreyLevels, TwoPercentAtEachEndAreLeftOut) {
  Image image = picture(10, 10, 100);
  image.pixels[0] = 3;    // 1 % darker
  image.pixels[1] = 250;  // 1 % brighter
  EXPECT_EQ(grey_levels(image).dark, 100);
  EXPECT_EQ(grey_levels(image).bright, 100);
  for (std::size_t i = 0; i < 3; ++i) image.pixels[i] = 3, image.pixels[50 + i] = 250;
  EXPECT_EQ(grey_levels(image).dark, 3);
  EXPECT_EQ(grey_levels(image).bright, 250);
}

TEST(GreyLevels, SaturatedPixelsAreCounted) {
  Image image = picture(10, 10, 254);
  for (std::size_t i = 0; i < 7; ++i) image.pixels[i] = 255;
  EXPECT_DOUBLE_EQ(grey_levels(image).saturated_fraction, 0.07);
}

TEST(GreyLevels, APictureMustHaveAsManyPixelsAsItsRegionSays) {
  EXPECT_FALSE(has_pixels({}));
  EXPECT_TRUE(has_pixels(picture(3, 4, 0)));
  Image image = picture(3, 4, 0);
  image.pixels.pop_back();
  EXPECT_FALSE(has_pixels(image));
  image.region.width = -3;
  EXPECT_FALSE(has_pixels(image));
}

}  // namespace
}  // namespace understudy::vision

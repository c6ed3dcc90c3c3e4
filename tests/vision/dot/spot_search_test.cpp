#include <gtest/gtest.h>

#include "tests/vision/dot/synthetic_spot.h"
#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr int kSize = 96;

Image spots(const std::vector<SyntheticSpot>& all, double ambient = 12) {
  LightField light = flat_light(kSize, kSize, ambient);
  for (const SyntheticSpot& s : all) add_spot(light, kSize, s);
  return quantise(light, kSize);
}

TEST(SpotSearch, FindsASpotToAPixel) {
  Random random(1, "spot search");
  for (int n = 0; n < 100; ++n) {
    const Vec2 centre(random.uniform(15, 80), random.uniform(15, 80));
    const auto guess = find_spot(spots({{centre, 2.5, 2.5, 80}}), {});
    ASSERT_TRUE(guess);
    EXPECT_LE((guess->centre - centre).norm(), 1);
  }
}

TEST(SpotSearch, PrefersTheExpectedSizeOverTheBrighterSpot) {
  const auto guess = find_spot(spots({{Vec2(25, 25), 7, 7, 150}, {Vec2(70, 70), 2.5, 2.5, 80}}), {});
  ASSERT_TRUE(guess);
  EXPECT_LE((guess->centre - Vec2(70, 70)).norm(), 1);
}

TEST(SpotSearch, OfEqualSizesTheBrighterIsTaken) {
  const auto guess = find_spot(spots({{Vec2(25, 25), 2.5, 2.5, 120}, {Vec2(70, 70), 2.5, 2.5, 80}}), {});
  ASSERT_TRUE(guess);
  EXPECT_LE((guess->centre - Vec2(25, 25)).norm(), 1);
}

TEST(SpotSearch, FindsNothingInAPlainPictureOrASpotTooFaint) {
  EXPECT_FALSE(find_spot(spots({}), {}));
  EXPECT_FALSE(find_spot(spots({{Vec2(40, 40), 2.5, 2.5, 2}}), {})) << "a sixth of the contrast asked for";
  EXPECT_TRUE(find_spot(spots({{Vec2(40, 40), 2.5, 2.5, 30}}), {}));
}

}  // namespace
}  // namespace understudy::vision

#include "vision/dot/dot.h"

#include <gtest/gtest.h>

#include "tests/vision/dot/synthetic_spot.h"

namespace understudy::vision {
namespace {

constexpr int kSize = 64;

Image noisy_spot(const SyntheticSpot& spot, std::uint64_t seed, double ambient = 12) {
  Random random(seed, "dot test");
  LightField light = flat_light(kSize, kSize, ambient);
  add_spot(light, kSize, spot);
  return expose(light, kSize, {}, random);
}

TEST(LaserDot, FollowsASpotThroughThePixelGridWithoutBias) {
  // Rounding to 8 bits alone scatters a centroid of this flux by sqrt(pi R^4 / 4 / 12) / F = 0.002 px.
  for (const double sigma : {1.2, 2.4, 4.0}) {
    for (int k = 0; k < 40; ++k) {
      const Vec2 centre(30 + 0.05 * k, 31.3 + 0.031 * k);
      LightField light = flat_light(kSize, kSize, 12.4);
      add_spot(light, kSize, {centre, sigma, sigma, 140});
      const DotMeasurement m = measure_dot(quantise(light, kSize), {.expected_radius_px = 2 * sigma});
      ASSERT_EQ(m.status, DotStatus::ok);
      EXPECT_LT((m.position_px - centre).norm(), 0.01)
          << "sigma " << sigma << " centre " << centre.transpose();
      EXPECT_NEAR(m.radius_px, 2 * std::sqrt(sigma * sigma + 1.0 / 12), 0.05 * sigma);
      // Integration over the pixel widens the spot by 1/12 px^2; moments of this flux are good to 2 %.
      EXPECT_NEAR(m.contrast, 140 * sigma * sigma / (sigma * sigma + 1.0 / 12), 3);
    }
  }
}

TEST(LaserDot, StaysUnderAHundredthOfAPixelOrTwoWithCameraNoise) {
  // docs/reference.md#dot-and-gap: 0.013 px RMS with 8 bits and noise.
  double sum = 0;
  constexpr int kFrames = 200;
  for (int k = 0; k < kFrames; ++k) {
    Random random(static_cast<std::uint64_t>(k), "place");
    const Vec2 centre(random.uniform(25, 39), random.uniform(25, 39));
    const DotMeasurement m =
        measure_dot(noisy_spot({centre, 2.4, 3.0, 130}, static_cast<std::uint64_t>(k)), {});
    ASSERT_EQ(m.status, DotStatus::ok);
    sum += (m.position_px - centre).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / (2 * kFrames)), 0.02);
}

TEST(LaserDot, LongObliqueSpotsAreMeasuredToo) {
  const Vec2 centre(31.2, 32.7);
  const DotMeasurement m = measure_dot(noisy_spot({centre, 7.0, 2.0, 100}, 3), {});
  ASSERT_EQ(m.status, DotStatus::ok);
  EXPECT_LT((m.position_px - centre).norm(), 0.15);
  EXPECT_GT(m.covariance_px2(0, 0), m.covariance_px2(1, 1));
}

TEST(LaserDot, AddsTheRegionsPlaceOnTheSensor) {
  Image image = noisy_spot({Vec2(30, 31), 2.4, 2.4, 120}, 1);
  const Vec2 at_origin = measure_dot(image, {}).position_px;
  image.region.x = 200;
  image.region.y = 77;
  EXPECT_LT((measure_dot(image, {}).position_px - at_origin - Vec2(200, 77)).norm(), 1e-9);
}

TEST(LaserDot, ASlopeOfTheAmbientLightDoesNotPullIt) {
  const Vec2 centre(32.3, 30.6);
  LightField light = flat_light(kSize, kSize, 0);
  for (int i = 0; i < kSize * kSize; ++i) light[static_cast<std::size_t>(i)] = 10 + 0.4 * (i % kSize);
  add_spot(light, kSize, {centre, 2.4, 2.4, 100});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  ASSERT_EQ(m.status, DotStatus::ok);
  EXPECT_LT((m.position_px - centre).norm(), 0.02);  // unmodelled, the slope would pull by 0.2 px
}

TEST(LaserDot, TheNozzlesDarkEdgeNearbyDoesNotPullIt) {
  const Vec2 centre(32, 32);
  LightField light = flat_light(kSize, kSize, 14);
  for (int i = 0; i < kSize * kSize; ++i) {
    if (i % kSize < 20) light[static_cast<std::size_t>(i)] = 3;
  }
  add_spot(light, kSize, {centre, 2.4, 2.4, 100});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  ASSERT_EQ(m.status, DotStatus::ok);
  EXPECT_LT((m.position_px - centre).norm(), 0.03);
}

TEST(LaserDot, OfTwoBlobsTheOneOfExpectedSizeIsTaken) {
  const Vec2 dot(20, 40), glint(45, 15);
  LightField light = flat_light(kSize, kSize, 12);
  add_spot(light, kSize, {dot, 2.4, 2.4, 120});
  add_spot(light, kSize, {glint, 7, 7, 150});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  EXPECT_LT((m.position_px - dot).norm(), 0.1);
}

TEST(LaserDot, OfTwoBlobsOfOneSizeTheBrighterIsTaken) {
  LightField light = flat_light(kSize, kSize, 12);
  add_spot(light, kSize, {Vec2(18, 40), 2.4, 2.4, 90});
  add_spot(light, kSize, {Vec2(45, 20), 2.4, 2.4, 150});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  EXPECT_LT((m.position_px - Vec2(45, 20)).norm(), 0.1);
}

TEST(LaserDot, SaysNoDotWhereThereIsNone) {
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(measure_dot(noisy_spot({Vec2(32, 32), 2.4, 2.4, 0}, static_cast<std::uint64_t>(k)), {}).status,
              DotStatus::no_dot);
    EXPECT_EQ(measure_dot(noisy_spot({Vec2(32, 32), 2.4, 2.4, 5}, static_cast<std::uint64_t>(k)), {}).status,
              DotStatus::no_dot);
  }
  EXPECT_EQ(measure_dot(quantise(flat_light(kSize, kSize, 0), kSize), {}).status, DotStatus::no_dot);
}

TEST(LaserDot, SaysSaturated) {
  LightField light = flat_light(kSize, kSize, 12);
  add_spot(light, kSize, {Vec2(32, 32), 2.4, 2.4, 900});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  EXPECT_EQ(m.status, DotStatus::saturated);
  EXPECT_GT(m.saturated_fraction, 0.2);
  EXPECT_EQ(measure_dot(quantise(flat_light(kSize, kSize, 255), kSize), {}).status, DotStatus::saturated);
}

TEST(LaserDot, SaysClippedByTheBorder) {
  for (const Vec2& centre : {Vec2(2, 32), Vec2(61, 32), Vec2(32, 1), Vec2(32, 63.4)}) {
    EXPECT_EQ(measure_dot(noisy_spot({centre, 2.4, 2.4, 150}, 1), {}).status, DotStatus::clipped_by_border);
  }
}

TEST(LaserDot, AWindowThatShrinksAtTheBorderStaysUnbiased) {
  const Vec2 centre(6, 32);  // 2.5 standard deviations inside
  LightField light = flat_light(kSize, kSize, 12);
  add_spot(light, kSize, {centre, 2.4, 2.4, 140});
  const DotMeasurement m = measure_dot(quantise(light, kSize), {});
  ASSERT_EQ(m.status, DotStatus::ok);
  EXPECT_LT((m.position_px - centre).norm(), 0.02);
}

TEST(LaserDot, SaysNotASpotForALitHalfPlane) {
  LightField light = flat_light(kSize, kSize, 12);
  for (int i = 0; i < kSize * kSize; ++i) {
    if (i % kSize > 30) light[static_cast<std::size_t>(i)] = 120;
  }
  EXPECT_NE(measure_dot(quantise(light, kSize), {}).status, DotStatus::ok);
}

TEST(LaserDot, NeverThrowsWhateverThePicture) {
  Random random(5, "fuzz");
  for (int k = 0; k < 400; ++k) {
    const int width = static_cast<int>(random.uniform(0, 40)),
              height = static_cast<int>(random.uniform(0, 40));
    Image image{{0, 0, width, height}, {}};
    const double white = random.uniform();
    for (int i = 0; i < width * height; ++i) {
      image.pixels.push_back(random.uniform() < white ? static_cast<std::uint8_t>(random.uniform(0, 256))
                                                      : std::uint8_t{0});
    }
    const DotOptions options{.expected_radius_px = random.uniform(-1, 30),
                             .speckle_area_px2 = random.uniform(-1, 3)};
    EXPECT_NO_THROW({
      const DotMeasurement m = measure_dot(image, options);
      if (m.status == DotStatus::ok) {
        EXPECT_TRUE(m.position_px.allFinite() && m.covariance_px2.allFinite()) << "case " << k;
      }
    }) << "case "
       << k;
  }
  Image torn{{0, 0, 30, 30}, {1, 2, 3}};  // fewer pixels than its region says
  EXPECT_EQ(measure_dot(torn, {}).status, DotStatus::no_dot);
  EXPECT_EQ(measure_dot(Image{}, {}).status, DotStatus::no_dot);
}

TEST(LaserDot, EqualPicturesGiveEqualBits) {
  const Image image = noisy_spot({Vec2(31.3, 30.2), 2.4, 3, 120}, 9);
  const DotMeasurement a = measure_dot(image, {}), b = measure_dot(image, {});
  EXPECT_EQ(a.position_px, b.position_px);
  EXPECT_EQ(a.covariance_px2, b.covariance_px2);
  EXPECT_EQ(a.contrast, b.contrast);
}

}  // namespace
}  // namespace understudy::vision

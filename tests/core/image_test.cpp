#include "core/image.h"

#include <limits>

#include <gtest/gtest.h>

namespace understudy {
namespace {

Camera pinhole() {
  Camera camera;
  camera.width = 640, camera.height = 480;
  camera.focal_px = 1000;
  camera.centre_px = {320, 240};
  return camera;
}

TEST(Image, IsReadRowByRowFromTheTop) {
  const Image image{{10, 20, 3, 2}, {0, 1, 2, 3, 4, 5}};
  EXPECT_EQ(image.at(0, 0), 0);
  EXPECT_EQ(image.at(2, 0), 2);
  EXPECT_EQ(image.at(0, 1), 3) << "the region's place on the sensor takes no part";
}

TEST(Region, IsClippedWhateverItAsksFor) {
  const Region sensor = pinhole().sensor();
  EXPECT_EQ(clipped({10, 20, 30, 40}, sensor), (Region{10, 20, 30, 40}));
  EXPECT_EQ(clipped({-10, 470, 30, 40}, sensor), (Region{0, 470, 20, 10}));
  EXPECT_EQ(clipped({700, -50, 30, 40}, sensor), (Region{640, 0, 0, 0}));
  EXPECT_EQ(clipped({10, 20, -5, 40}, sensor), (Region{10, 20, 0, 40}));
  constexpr int kLargest = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
  EXPECT_EQ(clipped({10, 20, kLargest, kLargest}, sensor), (Region{10, 20, 630, 460})) << "beyond an int";
  EXPECT_EQ(clipped({kLeast, kLargest, kLargest, kLargest}, sensor), (Region{0, 480, 0, 0}));
  EXPECT_EQ(clipped({0, 0, 12, 22}, {10, 20, 3, 2}), (Region{10, 20, 2, 2}));
}

TEST(Camera, APinholeIsSimilarTriangles) {
  EXPECT_EQ(*pinhole().project({0, 0, 0.2}), Vec2(320, 240));
  EXPECT_NEAR((*pinhole().project({0.01, -0.02, 0.2}) - Vec2(320 + 50, 240 - 100)).norm(), 0, 1e-10);
  EXPECT_FALSE(pinhole().project({0.01, 0, 0}));
  EXPECT_FALSE(pinhole().project({0.01, 0, -0.2}));
}

TEST(Camera, DistortsAsBrownWroteIt) {
  Camera camera = pinhole();
  camera.k1 = -0.3, camera.k2 = 0.1;
  // (x, y) = (0.3, -0.4): r^2 = 0.25, the factor 1 - 0.3 * 0.25 + 0.1 * 0.0625.
  const double factor = 1 - 0.075 + 0.00625;
  const Vec3 point(0.3, -0.4, 1);
  EXPECT_NEAR((*camera.project(point) - Vec2(320 + 300 * factor, 240 - 400 * factor)).norm(), 0, 1e-10);
  // Tangential: 2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y.
  camera = pinhole();
  camera.p1 = 0.01, camera.p2 = -0.02;
  const double dx = 2 * 0.01 * -0.12 - 0.02 * (0.25 + 0.18), dy = 0.01 * (0.25 + 0.32) - 2 * 0.02 * -0.12;
  EXPECT_NEAR((*camera.project(point) - Vec2(620 + 1000 * dx, -160 + 1000 * dy)).norm(), 0, 1e-10);
}

}  // namespace
}  // namespace understudy

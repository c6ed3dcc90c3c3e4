#include "vision/boards/lens_distortion.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::vision {
namespace {

Camera bent() {
  Camera c{1600, 1200, 4267, Vec2(810, 590)};
  c.k1 = -0.12, c.k2 = 0.15, c.p1 = 4e-4, c.p2 = -3e-4;
  return c;
}

TEST(LensDistortion, TheRayOfAPixelIsProjectedToThatPixel) {
  Random random(1, "lens");
  for (int n = 0; n < 1000; ++n) {
    const Vec2 pixel(random.uniform(0, 1600), random.uniform(0, 1200));
    const Vec2 ray = ray_of_pixel(bent(), pixel);
    EXPECT_LE((bent().project(Vec3(ray.x(), ray.y(), 1)).value() - pixel).norm(),
              1e-8);  // 1e-12 rad of 4267 px
  }
}

TEST(LensDistortion, WithoutDistortionARayIsAStraightPinholes) {
  Camera pinhole = bent();
  pinhole.k1 = pinhole.k2 = pinhole.p1 = pinhole.p2 = 0;
  const Vec2 ray = ray_of_pixel(pinhole, Vec2(810 + 426.7, 590 - 853.4));
  EXPECT_LE((ray - Vec2(0.1, -0.2)).norm(), 1e-15);
  EXPECT_LE((without_distortion(pinhole, Vec2(100, 200)) - Vec2(100, 200)).norm(), 1e-12);
}

TEST(LensDistortion, RadialDistortionFollowsItsPolynomial) {
  Camera radial = bent();
  radial.p1 = radial.p2 = 0;
  const double r = 0.15, scale = 1 + radial.k1 * r * r + radial.k2 * r * r * r * r;
  const Vec2 seen = with_distortion(radial, radial.centre_px + Vec2(radial.focal_px * r, 0));
  EXPECT_NEAR(seen.x(), radial.centre_px.x() + radial.focal_px * r * scale, 1e-9);
  EXPECT_NEAR(seen.y(), radial.centre_px.y(), 1e-12);
}

TEST(LensDistortion, WithAndWithoutAreInverses) {
  Random random(2, "lens there and back");
  for (int n = 0; n < 1000; ++n) {
    const Vec2 pixel(random.uniform(0, 1600), random.uniform(0, 1200));
    EXPECT_LE((with_distortion(bent(), without_distortion(bent(), pixel)) - pixel).norm(), 1e-8);
  }
}

TEST(LensDistortion, WhereTheLensFoldsOverTheAnswerIsFinite) {
  Camera folded = bent();
  folded.k1 = -2;
  EXPECT_TRUE(ray_of_pixel(folded, Vec2(1e5, -1e5)).allFinite());
}

}  // namespace
}  // namespace understudy::vision

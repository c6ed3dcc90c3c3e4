#include "vision/boards/target_outline.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/vision/boards/drawn_picture.h"

namespace understudy::vision {
namespace {

TargetOptions options() {
  TargetOptions o;
  o.camera = {400, 300, 4267, Vec2(200, 150)};
  o.radius_px = 50;
  return o;
}

TEST(TargetOutline, DarkBlobsOfNearlyTheExpectedAreaAreFound) {
  const Image image =
      drawn_discs(400, 300, {{Vec2(100.4, 120.7), 50}, {Vec2(250, 80), 12}, {Vec2(330.2, 200.1), 45}});
  const auto blobs = find_dark_blobs(image, 50);
  ASSERT_EQ(blobs.size(), 2u) << "the small one is none";
  EXPECT_LE((blobs[0].centre - Vec2(100.4, 120.7)).norm(), 0.1);
  EXPECT_NEAR(blobs[0].radius, 50, 0.6);  // by whole pixels
  EXPECT_FALSE(blobs[0].at_border);
}

TEST(TargetOutline, ABlobAtTheBorderIsClipped) {
  const Image image = drawn_discs(400, 300, {{Vec2(30, 150), 50}});
  const auto blobs = find_dark_blobs(image, 50);
  ASSERT_EQ(blobs.size(), 1u);
  EXPECT_TRUE(blobs[0].at_border);
  EXPECT_EQ(measure_outline(image, blobs[0], options()).status, TargetStatus::clipped_by_border);
}

TEST(TargetOutline, OfADiscIsItsCircle) {
  for (const Vec2& centre : {Vec2(200, 150), Vec2(180.25, 140.5), Vec2(215.9, 161.3)}) {
    const Image image = drawn_discs(400, 300, {{centre, 50.4}});
    const TargetMeasurement m = measure_outline(image, find_dark_blobs(image, 50).front(), options());
    ASSERT_EQ(m.status, TargetStatus::ok) << to_string(m.status);
    EXPECT_LE((m.outline_px - centre).norm(), 0.03);
    EXPECT_NEAR(m.radius_px, 50.4, 0.1);
    EXPECT_LE((m.outline_px - centre).norm(), 3 * std::sqrt(m.covariance_px2.trace()));
  }
}

TEST(TargetOutline, TheSpheresCentreIsNearerToTheAxisThanItsOutlines) {
  // (b / f)^2 = q moves the centre to 1 / (1 + q) of its distance from the axis.
  TargetOptions wide = options();
  wide.camera.focal_px = 500;
  const Image image = drawn_discs(400, 300, {{Vec2(320, 150), 50}});
  const TargetMeasurement m = measure_outline(image, find_dark_blobs(image, 50).front(), wide);
  ASSERT_EQ(m.status, TargetStatus::ok);
  EXPECT_NEAR(m.centre_px.x(), 200 + 120 / (1 + 0.01), 0.05);
  EXPECT_NEAR(m.centre_px.y(), 150, 0.05);
}

TEST(TargetOutline, AnOutlineThatSomethingHidesIsRefused) {
  const Image image = drawn_picture(400, 300, [](double u, double v) {
    const bool disc = std::hypot(u - 200, v - 150) <= 50, arm = u > 225 && std::abs(v - 150) < 20;
    return disc || arm ? kInk : kPaper;
  });
  Blob blob{Vec2(200, 150), 50, false};
  TargetOptions strict = options();
  strict.hidden_fraction_max = 0.1;  // the arm covers 2 asin(20/50) = 13 % of the outline
  EXPECT_EQ(measure_outline(image, blob, strict).status, TargetStatus::partly_hidden);
}

}  // namespace
}  // namespace understudy::vision

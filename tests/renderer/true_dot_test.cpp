#include <gtest/gtest.h>

#include "tests/renderer/laser_scene.h"

namespace understudy::renderer {
namespace {

TEST(TrueDot, LiesWhereTheBeamMeetsASphere) {
  LaserScene scene = clean_scene();
  scene.tool_bodies = {};
  scene.table = false;
  // A ball on the tool stands in for a part: its hit has a closed form.
  const Vec3 centre(0, 0.6e-3, -3e-3);
  constexpr double kRadius = 2e-3;
  geometry::Shape ball{"ball", geometry::Sphere{kRadius}};
  ball.X_FS.translation() = centre;
  scene.tool_bodies.push_back(ball);
  const Vec3 o = scene.X_TL.translation() - centre, d = scene.X_TL.linear().col(2);
  const double t = -o.dot(d) - std::sqrt(o.dot(d) * o.dot(d) - o.squaredNorm() + kRadius * kRadius);
  const auto expected = scene.camera.project(scene.X_TC.inverse() * (scene.X_TL.translation() + t * d));
  Vec2 dot;
  ASSERT_TRUE(true_dot(scene, dot));
  EXPECT_LT((dot - *expected).norm(), 1e-6);
}

TEST(TrueDot, MovesWithTheSurfaceByTheShiftOfSong) {
  // docs/reference.md#dot-and-gap: shift = S sin(alpha + beta) / cos(alpha) px per mm of gap for devices on
  // opposite sides of the normal; 45 / 45 degrees at 100 px/mm gives 141 px/mm.
  LaserScene scene = clean_scene();
  scene.tool_bodies = {};
  const double a = from_deg(45);
  // Far away, so that the camera is nearly orthographic: perspective changes the scale by 1 mm in 10 m.
  scene.X_TL = looking({0, 0, 0}, {0, -std::sin(a), -std::cos(a)}, {-1, 0, 0}, 30e-3);
  scene.X_TC = looking({0, 0, 0}, {0, std::sin(a), -std::cos(a)}, {1, 0, 0}, 10);
  scene.camera.focal_px = 100e3 * 10;
  Vec2 near, far;
  scene.X_WT.translation().z() = 0.1e-3;
  ASSERT_TRUE(true_dot(scene, near));
  scene.X_WT.translation().z() = 1.1e-3;
  ASSERT_TRUE(true_dot(scene, far));
  EXPECT_NEAR((far - near).norm(), 141.42, 0.05);
}

TEST(TrueDot, IsNotSeenOffTheSensorOrWhenTheBeamMeetsNothing) {
  LaserScene scene = clean_scene();
  Vec2 dot;
  scene.X_WT.translation().z() = 30e-3;
  EXPECT_FALSE(true_dot(scene, dot));
  scene = clean_scene();
  scene.table = false;
  EXPECT_FALSE(true_dot(scene, dot));
}

}  // namespace
}  // namespace understudy::renderer

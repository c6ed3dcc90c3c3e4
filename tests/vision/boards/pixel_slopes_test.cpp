#include "vision/boards/pixel_slopes.h"

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::vision {
namespace {

MountedCamera bent_camera() {
  MountedCamera camera = default_calibration_rig(Vec3(0, 0, 0.1)).cameras[1];
  camera.camera.k1 = -0.12, camera.camera.k2 = 0.15, camera.camera.p1 = 4e-4, camera.camera.p2 = -3e-4;
  camera.X_WC = camera.X_WC * make_pose(exp_rotation(Vec3(0.02, -0.03, 0.1)), Vec3(1e-3, 2e-3, -3e-3));
  return camera;
}

Vec2 projected(const MountedCamera& camera, const Vec3& p_W) {
  return camera.camera.project(camera.X_WC.inverse() * p_W).value();
}

// Central differences err by the square of the step: 1e-6 of slopes that are up to 1e4 px.
TEST(PixelSlopes, AreThoseOfTheProjection) {
  const MountedCamera camera = bent_camera();
  Random random(3, "pixel slopes");
  for (int n = 0; n < 50; ++n) {
    const Vec3 p_W = Vec3(0, 0, 0.13) + 40e-3 * normal_vec3(random).cwiseMax(-1.5).cwiseMin(1.5);
    PixelSlopes at;
    ASSERT_TRUE(pixel_slopes(camera, p_W, at));
    EXPECT_LT((at.pixel - projected(camera, p_W)).norm(), 1e-9);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vec3 step = 1e-6 * Vec3::Unit(k);
      const Vec2 slope = (projected(camera, p_W + step) - projected(camera, p_W - step)) / 2e-6;
      EXPECT_LT((at.by_point.col(k) - slope).norm(), 1e-6 * at.by_point.norm()) << k;
    }
    for (Eigen::Index k = 0; k < kCameraNumbers; ++k) {
      const double size = k >= 6 && k < 9 ? 1e-2 : 1e-6;
      const CameraStep step = size * CameraStep::Unit(k);
      const Vec2 slope =
          (projected(moved(camera, step), p_W) - projected(moved(camera, -step), p_W)) / (2 * size);
      EXPECT_LT((at.by_camera.col(k) - slope).norm(), 1e-6 * std::max(1.0, slope.norm())) << k;
    }
  }
}

TEST(PixelSlopes, APointBehindTheCameraHasNone) {
  const MountedCamera camera = bent_camera();
  PixelSlopes at;
  EXPECT_FALSE(pixel_slopes(camera, camera.X_WC * Vec3(0, 0, -0.1), at));
}

}  // namespace
}  // namespace understudy::vision

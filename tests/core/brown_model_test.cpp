#include "core/brown_model.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

Camera bent() {
  Camera camera;
  camera.focal_px = 2000, camera.centre_px = {320, 240};
  camera.k1 = -0.2, camera.k2 = 0.07, camera.p1 = 1e-3, camera.p2 = -2e-3;
  return camera;
}

// Camera::project is the other way to the same pixel.
TEST(BrownModel, AgreesWithTheCameraAndItsDifferences) {
  const Camera camera = bent();
  constexpr double kStep = 1e-6;  // a central difference: of the order of 1e-12, and rounding of 1e-10
  for (const Vec2& ray : {Vec2(0, 0), Vec2(0.1, -0.2), Vec2(-0.3, 0.25)}) {
    const auto through = [&](const Vec2& r) {
      return Vec2((*camera.project(Vec3(r.x(), r.y(), 1)) - camera.centre_px) / camera.focal_px);
    };
    const DistortedRay seen = distort(camera, ray);
    EXPECT_LT((seen.ray - through(ray)).norm(), 1e-14);
    for (int axis = 0; axis < 2; ++axis) {
      const Vec2 step = kStep * Vec2::Unit(axis);
      const Vec2 slope = (through(ray + step) - through(ray - step)) / (2 * kStep);
      EXPECT_LT((seen.slopes.col(axis) - slope).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace understudy

#include "renderer/lens.h"

#include <gtest/gtest.h>

namespace understudy::renderer {
namespace {

TEST(Lens, RaysProjectBackToTheirSamples) {
  for (const double k1 : {0.0, -0.4}) {
    Camera camera{.width = 160, .height = 120, .focal_px = 500, .centre_px = {81, 57}};
    camera.k1 = k1;
    camera.k2 = k1 * 0.2;
    camera.p1 = k1 * 0.01;
    camera.p2 = k1 * -0.02;
    const Lens lens(camera, 3);
    EXPECT_EQ(lens.distorts(), k1 != 0);
    for (int j = -6; j < 246; j += 9) {
      for (int i = -6; i < 326; i += 7) {
        const Vec2 ray = lens.ray(i, j);
        const Vec2 pixel = *camera.project({ray.x(), ray.y(), 1});
        EXPECT_LT((pixel - Vec2(pixel_of_sample(i), pixel_of_sample(j))).norm(), 1e-6);
      }
    }
  }
}

TEST(Lens, TheIdealSamplesCoverTheRegion) {
  Camera camera{.width = 160, .height = 120, .focal_px = 200, .centre_px = {81, 57}};
  camera.k1 = -0.3;
  const Lens lens(camera, 2);
  const Region r = lens.ideal_samples({20, 10, 60, 50});
  for (int j = 20; j < 120; ++j) {
    for (int i = 40; i < 160; ++i) {
      const Vec2 at = lens.ideal_sample(i, j);
      EXPECT_TRUE(at.x() >= r.x && at.y() >= r.y && at.x() < r.x + r.width - 1 &&
                  at.y() < r.y + r.height - 1);
    }
  }
}

}  // namespace
}  // namespace understudy::renderer

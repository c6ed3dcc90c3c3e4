#include "vision/boards/lens_distortion.h"

#include <Eigen/LU>

namespace understudy::vision {

Vec2 ray_of_pixel(const Camera& camera, const Vec2& pixel) {
  const Vec2 seen = (pixel - camera.centre_px) / camera.focal_px;
  Vec2 ray = seen;
  for (int i = 0; i < 12; ++i) {
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (camera.k1 + r2 * camera.k2);
    const double slope = 2 * (camera.k1 + 2 * r2 * camera.k2);  // of radial over x is slope * x
    const Vec2 miss(x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x) - seen.x(),
                    y * radial + camera.p1 * (r2 + 2 * y * y) + 2 * camera.p2 * x * y - seen.y());
    Eigen::Matrix2d J;
    J << radial + slope * x * x + 2 * camera.p1 * y + 6 * camera.p2 * x,
        slope * x * y + 2 * camera.p1 * x + 2 * camera.p2 * y,
        slope * x * y + 2 * camera.p1 * x + 2 * camera.p2 * y,
        radial + slope * y * y + 6 * camera.p1 * y + 2 * camera.p2 * x;
    if (!(J.determinant() > 1e-3)) break;
    const Vec2 step = J.inverse() * miss;
    ray -= step;
    if (step.norm() < 1e-12) break;
  }
  return ray;
}

Vec2 without_distortion(const Camera& camera, const Vec2& pixel) {
  return camera.centre_px + camera.focal_px * ray_of_pixel(camera, pixel);
}

Vec2 with_distortion(const Camera& camera, const Vec2& ideal_pixel) {
  const Vec2 ray = (ideal_pixel - camera.centre_px) / camera.focal_px;
  return camera.project({ray.x(), ray.y(), 1}).value();
}

}  // namespace understudy::vision

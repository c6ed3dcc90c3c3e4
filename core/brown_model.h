// Brown's model of a lens (Camera in core/image.h) with its slopes.
#pragma once

#include "core/image.h"

namespace understudy {

struct DistortedRay {
  Vec2 ray{0, 0};          ///< (x, y) of a viewing ray (x, y, 1) after the lens
  Eigen::Matrix2d slopes;  ///< of that over the ray before the lens
};

/// Of the viewing ray (x, y, 1); the pixel is centre + focal length * ray.
DistortedRay distort(const Camera& camera, const Vec2& ray);

}  // namespace understudy

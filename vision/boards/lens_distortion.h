// From pixels to rays through a lens with Brown distortion; Camera::project is the inverse.
#pragma once

#include "core/image.h"

namespace understudy::vision {

/// Ray (x, y, 1) in the camera's frame that is seen at `pixel`. Newton's method to 1e-12 rad; where the lens
/// folds over (far outside of its picture) the answer is the last step's, finite but not exact.
Vec2 ray_of_pixel(const Camera& camera, const Vec2& pixel);

/// The pixel of that ray in a camera without distortion, and back.
Vec2 without_distortion(const Camera& camera, const Vec2& pixel);
Vec2 with_distortion(const Camera& camera, const Vec2& ideal_pixel);

}  // namespace understudy::vision

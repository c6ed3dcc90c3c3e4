#include "core/image.h"

namespace understudy {

std::optional<Vec2> Camera::project(const Vec3& p_C) const {
  if (!(p_C.z() > 0)) return std::nullopt;
  const double x = p_C.x() / p_C.z();
  const double y = p_C.y() / p_C.z();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * k2);
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return Vec2(centre_px.x() + focal_px * xd, centre_px.y() + focal_px * yd);
}

}  // namespace understudy

#include "core/brown_model.h"

namespace understudy {

DistortedRay distort(const Camera& c, const Vec2& ray) {
  const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (c.k1 + r2 * c.k2);
  const double slope = 2 * (c.k1 + 2 * r2 * c.k2);  // d radial / dx is slope x
  const double mixed = slope * x * y + 2 * c.p1 * x + 2 * c.p2 * y;
  DistortedRay to;
  to.ray = {x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
            y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
  to.slopes << radial + slope * x * x + 2 * c.p1 * y + 6 * c.p2 * x, mixed, mixed,
      radial + slope * y * y + 6 * c.p1 * y + 2 * c.p2 * x;
  return to;
}

}  // namespace understudy

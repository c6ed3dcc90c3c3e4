#include "geometry/table_surface.h"

#include <cmath>

namespace understudy::geometry {

Vec3 TableSurface::normal(const Vec2& p) const {
  const Vec2 gradient = slope - 2 * bow / (radius * radius) * p;
  return Vec3(-gradient.x(), -gradient.y(), 1).normalized();
}

/// The height above a paraboloid is a quadratic in the distance: the root at which it falls through 0, in the
/// form that loses nothing where the square is small.
std::optional<double> TableSurface::ray_hit(const Vec3& origin, const Vec3& direction) const {
  const Vec2 p = origin.head<2>(), d = direction.head<2>();
  const double k = bow / (radius * radius);
  const double a = k * d.squaredNorm(), b = direction.z() - slope.dot(d) + 2 * k * p.dot(d);
  const double c = origin.z() - z(p);
  const double under_root = b * b - 4 * a * c;
  if (b >= 0 || under_root < 0) return std::nullopt;
  const double distance = -2 * c / (b - std::sqrt(under_root));
  if (!reaches(p + distance * d)) return std::nullopt;
  return distance;
}

}  // namespace understudy::geometry

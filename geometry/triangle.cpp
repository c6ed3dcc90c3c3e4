#include "geometry/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::geometry {

TrianglePoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {Vec3(1, 0, 0), Feature::corner0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {Vec3(0, 1, 0), Feature::corner1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {Vec3(1 - v, v, 0), Feature::edge0};
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {Vec3(0, 0, 1), Feature::corner2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {Vec3(1 - w, 0, w), Feature::edge2};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {Vec3(0, 1 - w, w), Feature::edge1};
  }
  const double scale = 1 / (va + vb + vc);
  return {Vec3(1 - (vb + vc) * scale, vb * scale, vc * scale), Feature::inside};
}

WatertightRay::WatertightRay(const Vec3& origin, const Vec3& direction) : origin_(origin) {
  direction.cwiseAbs().maxCoeff(&z_);
  x_ = (z_ + 1) % 3;
  y_ = (z_ + 2) % 3;
  shear_ = Vec3(direction[x_] / direction[z_], direction[y_] / direction[z_], 1 / direction[z_]);
  // A component of zero becomes one that cannot make 0 * infinity in the slab test.
  for (int i = 0; i < 3; ++i)
    inverse_[i] = 1 / std::copysign(std::max(std::abs(direction[i]), 1e-200), direction[i]);
}

std::optional<WatertightRay::Hit> WatertightRay::hit(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 A = a - origin_, B = b - origin_, C = c - origin_;
  const double ax = A[x_] - shear_[0] * A[z_], ay = A[y_] - shear_[1] * A[z_];
  const double bx = B[x_] - shear_[0] * B[z_], by = B[y_] - shear_[1] * B[z_];
  const double cx = C[x_] - shear_[0] * C[z_], cy = C[y_] - shear_[1] * C[z_];
  // An edge gives its two triangles the same products with opposite sign, hence no gap between them.
  const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double det = u + v + w;
  if (det == 0) return std::nullopt;  // edge-on: a neighbour takes the hit
  const double distance = (u * A[z_] + v * B[z_] + w * C[z_]) * shear_[2] / det;
  if (!(distance >= 0)) return std::nullopt;
  return Hit{distance, Vec3(u, v, w) / det};
}

double WatertightRay::entry(const Vec3& lower, const Vec3& upper, double reach) const {
  double from = 0, to = reach;
  for (int i = 0; i < 3; ++i) {
    const double s = (lower[i] - origin_[i]) * inverse_[i], t = (upper[i] - origin_[i]) * inverse_[i];
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  // Rounding of the slab distances must not lose a box that the ray grazes (Ize 2013).
  constexpr double kSlack = 1 + 8 * std::numeric_limits<double>::epsilon();
  return from <= to * kSlack ? from : std::numeric_limits<double>::infinity();
}

}  // namespace understudy::geometry

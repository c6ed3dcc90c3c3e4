#include "sim/distance/bead_core.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

constexpr double kEntryAccuracy = 1e-13;  // [m]
constexpr int kEntryIterationsMax = 200;  // Newton's steps halve the rest where a ray only grazes

}  // namespace

Vec3 BeadCore::farthest(const Vec3& direction) const {
  Vec3 p = middle;
  p += direction.dot(half_along) > 0 ? half_along : Vec3(-half_along);
  p += direction.dot(half_side) > 0 ? half_side : Vec3(-half_side);
  if (disc_radius > 0) {
    const Vec3 flat = direction - direction.dot(up) * up;
    const double length = flat.norm();
    // Straight along the disc's axis what is left of the direction is rounding, and points out of its plane.
    if (length > 1e-9 * direction.norm()) p += disc_radius / length * flat;
  }
  return p;
}

Vec3 BeadCore::nearest(const Vec3& p) const {
  const Vec3 r = p - middle;
  if (disc_radius > 0) {
    const Vec3 flat = r - r.dot(up) * up;
    const double length = flat.norm();
    return middle + (length > disc_radius ? Vec3(disc_radius / length * flat) : flat);
  }
  Vec3 q = middle;
  for (const Vec3& half : {half_along, half_side}) {
    const double length2 = half.squaredNorm();
    if (length2 > 0) q += std::clamp(r.dot(half) / length2, -1.0, 1.0) * half;
  }
  return q;
}

double BeadCore::reach() const {
  return std::sqrt(half_along.squaredNorm() + half_side.squaredNorm()) + disc_radius + radius;
}

BeadCore in_frame(const BeadCore& bead_W, const Pose& X_FW) {
  BeadCore bead = bead_W;
  bead.middle = X_FW * bead_W.middle;
  bead.half_along = X_FW.linear() * bead_W.half_along;
  bead.half_side = X_FW.linear() * bead_W.half_side;
  bead.up = X_FW.linear() * bead_W.up;
  return bead;
}

double signed_distance(const BeadCore& bead, const Vec3& p) {
  return (p - bead.nearest(p)).norm() - bead.radius;
}

Vec3 normal_at(const BeadCore& bead, const Vec3& p, const Vec3& fallback) {
  const Vec3 out = p - bead.nearest(p);
  const double length = out.norm();
  return length > 0 ? Vec3(out / length) : fallback;
}

// The distance to a convex set is convex along a line: Newton's steps come from outside and never pass the
// surface.
std::optional<double> entry(const BeadCore& bead, const Vec3& origin, const Vec3& direction, double reach) {
  double t = 0;
  for (int i = 0; i < kEntryIterationsMax; ++i) {
    const Vec3 p = origin + t * direction;
    const Vec3 out = p - bead.nearest(p);
    const double length = out.norm(), outside = length - bead.radius;
    if (outside <= kEntryAccuracy) return t;
    const double slope = out.dot(direction) / length;
    if (slope >= 0) return std::nullopt;
    t -= outside / slope;
    if (!(t <= reach)) return std::nullopt;
  }
  return t;
}

std::optional<double> leaving(const BeadCore& bead, const Vec3& origin, const Vec3& direction) {
  const double past = (bead.middle - origin).norm() + bead.reach();
  const auto back = entry(bead, origin + past * direction, -direction, past);
  if (!back) return std::nullopt;
  return past - *back;
}

}  // namespace understudy::sim

#include "sim/beads/bead_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "sim/distance/gjk.h"

namespace understudy::sim {
namespace {

constexpr double kWidest = 0.3;            // [m]: no nozzle lays more, and the tree holds it
constexpr double kFarthest = 100;          // [m] from the origin; beyond, floats are coarser than 8 um
constexpr double kDepthAccuracy = 0.5e-6;  // [m], along each direction of the core
constexpr double kEntryAccuracy = 1e-13;   // [m]
constexpr int kEntryIterationsMax = 200;   // Newton's steps halve the rest where a ray only grazes
constexpr double kUnitTolerance = 1e-3;    // of |up|: rounding to float is 1e-7, wrong units are far off

Vec3 wide(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

[[noreturn]] void refuse(const Bead& bead, const std::string& what) {
  throw InputError("bead of line " + std::to_string(bead.line) + ": " + what);
}

std::string mm(double metres) { return std::to_string(to_mm(metres)) + " mm"; }

// The largest of a concave function on [-1, 1], by golden section down to `accuracy`.
template <typename Function>
double most(const Function& f, double accuracy, double& at) {
  constexpr double kGolden = 0.6180339887498949;
  double low = -1, high = 1;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double fa = f(a), fb = f(b);
  while (high - low > accuracy) {
    if (fa > fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = f(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = f(b);
    }
  }
  at = fa > fb ? a : b;
  return std::max(fa, fb);
}

struct Deepest {
  double depth = 0;
  Vec3 place{0, 0, 0};
};

// Of the points of a bead's core in a solid's: depth is concave in the point.
template <typename Core>
Deepest deepest_point(const Core& core, const BeadCore& bead) {
  const auto depth = [&](const Vec3& p) {
    const double outside = (p - core.nearest(p)).norm();
    return outside > 0 ? -outside : core.depth(p);
  };
  Vec3 u = bead.half_along, v = bead.half_side;
  if (bead.disc_radius > 0) {
    u = bead.disc_radius * bead.up.unitOrthogonal();
    v = bead.up.cross(u);
  }
  const double along = u.norm(), across = v.norm();
  const double fine = across > 0 ? kDepthAccuracy / across : 3,
               coarse = along > 0 ? kDepthAccuracy / along : 3;
  Deepest result;
  double s = 0, t = 0;
  const auto best_across = [&](double a) {
    // A disc is narrower away from its middle.
    const double half = bead.disc_radius > 0 ? std::sqrt(1 - a * a) : 1;
    const double best =
        across > 0 ? most([&](double b) { return depth(bead.middle + a * u + b * half * v); }, fine, t)
                   : depth(bead.middle + a * u);
    t *= half;
    return best;
  };
  if (along > 0) most(best_across, coarse, s);
  result.depth = std::max(0.0, best_across(s));
  result.place = bead.middle + s * u + t * v;
  return result;
}

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

BeadCore core_of(const Bead& bead) {
  const Vec3 from = wide(bead.from_W), to = wide(bead.to_W), up = wide(bead.up_W).normalized();
  const double half_flat = 0.5 * (static_cast<double>(bead.width) - static_cast<double>(bead.height));
  BeadCore core;
  core.middle = 0.5 * (from + to);
  core.half_along = 0.5 * (to - from);
  core.radius = 0.5 * static_cast<double>(bead.height);
  const double half = core.half_along.norm();
  if (half == 0) {
    core.up = up;
    core.disc_radius = half_flat;
    return core;
  }
  const Vec3 along = core.half_along / half;
  Vec3 side = along.cross(up);
  const double sine = side.norm();
  // Laid straight along the tool axis, the section has no height direction of its own.
  side = sine > 1e-6 ? Vec3(side / sine) : along.unitOrthogonal();
  core.half_side = half_flat * side;
  core.up = side.cross(along);
  return core;
}

BeadCore in_frame(const BeadCore& bead_W, const Pose& X_FW) {
  BeadCore bead = bead_W;
  bead.middle = X_FW * bead_W.middle;
  bead.half_along = X_FW.linear() * bead_W.half_along;
  bead.half_side = X_FW.linear() * bead_W.half_side;
  bead.up = X_FW.linear() * bead_W.up;
  return bead;
}

void check(const Bead& bead) {
  const Vec3 up = wide(bead.up_W);
  for (const Vec3& p : {wide(bead.from_W), wide(bead.to_W)}) {
    if (!p.allFinite()) refuse(bead, "a coordinate is not finite");
    if (p.cwiseAbs().maxCoeff() > kFarthest)
      refuse(bead, "a coordinate of " + mm(p.cwiseAbs().maxCoeff()) + " is beyond " + mm(kFarthest));
  }
  if (!std::isfinite(bead.laid_at)) refuse(bead, "its time is not finite");
  if (!(std::abs(up.norm() - 1) <= kUnitTolerance))
    refuse(bead, "its normal has length " + std::to_string(up.norm()) + " instead of 1");
  if (!(bead.height > 0 && std::isfinite(bead.height)))
    refuse(bead, "its height of " + mm(bead.height) + " is not above 0");
  if (!(bead.width >= bead.height && bead.width <= static_cast<float>(kWidest)))
    refuse(bead, "its width of " + mm(bead.width) + " is not from its height of " + mm(bead.height) + " to " +
                     mm(kWidest));
}

template <typename Core>
Separation separation(const Core& core, double solid_radius, const Pose& X_WS, const BeadCore& bead_W,
                      double enough) {
  const double radii = solid_radius + bead_W.radius;
  const BeadCore bead = in_frame(bead_W, X_WS.inverse(Eigen::Isometry));
  const GjkResult apart = distance_to_bead_core(core, bead, enough + radii);
  if (apart.distance <= 0) {
    const Deepest deepest = deepest_point(core, bead);
    return {-radii - deepest.depth, X_WS * (deepest.depth > 0 ? deepest.place : apart.on_other)};
  }
  // From the bead's core towards the solid: its own surface, or the solid's where that is nearer.
  const Vec3 towards = core.nearest(apart.on_other) - apart.on_other;
  const double length = towards.norm();
  const double out = std::clamp(apart.distance - solid_radius, 0.0, bead.radius);
  const Vec3 place = length > 0 ? Vec3(apart.on_other + out / length * towards) : apart.on_other;
  return {apart.distance - radii, X_WS * place};
}

template Separation separation(const PointCore&, double, const Pose&, const BeadCore&, double);
template Separation separation(const SegmentCore&, double, const Pose&, const BeadCore&, double);
template Separation separation(const FrustumCore&, double, const Pose&, const BeadCore&, double);
template Separation separation(const BoxCore&, double, const Pose&, const BeadCore&, double);

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

#include "sim/beads/bead_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "sim/distance/gjk.h"
#include "sim/distance/hull_core.h"

namespace understudy::sim {
namespace {

constexpr double kWidest = 0.3;            // [m]: no nozzle lays more, and the tree holds it
constexpr double kFarthest = 100;          // [m] from the origin; beyond, floats are coarser than 8 um
constexpr double kDepthAccuracy = 0.5e-6;  // [m], along each direction of the core
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
template Separation separation(const HullCore&, double, const Pose&, const BeadCore&, double);

}  // namespace understudy::sim

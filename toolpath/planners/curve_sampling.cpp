#include "toolpath/planners/curve_sampling.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

using geometry::SurfacePoint;

constexpr double kFarthest = 5 * kMillimetre;
constexpr double kFinest = 1 * kMicrometre;    // [m], the steps of no drive are finer
constexpr double kCorner = 20 * kDegree;       // a polyline that turns by more is meant to
constexpr double kSwingPerStep = 5 * kDegree;  // over it, arc and chord of the swing agree to 0.1 %
constexpr double kSharpEdge = 20 * kDegree;

double angle(const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

// A stretch of the curve without corners, by arc length.
class Stretch {
 public:
  void add(const Vec3& p) {
    arc_.push_back(points_.empty() ? 0 : arc_.back() + (p - points_.back()).norm());
    points_.push_back(p);
  }
  double length() const { return arc_.back(); }
  Vec3 at(double s) const {
    const auto i = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, s) - arc_.begin();
    return points_[i - 1] + (s - arc_[i - 1]) / (arc_[i] - arc_[i - 1]) * (points_[i] - points_[i - 1]);
  }
  /// Where the curve must be looked at between two arc lengths: quarters, for an S has its chord through the
  /// middle, and the points the user gave.
  std::vector<double> probes(double from, double to) const {
    std::vector<double> at;
    for (const double part : {0.25, 0.5, 0.75}) at.push_back(from + part * (to - from));
    for (auto it = std::upper_bound(arc_.begin(), arc_.end(), from); it != arc_.end() && *it < to; ++it)
      at.push_back(*it);
    return at;
  }

 private:
  std::vector<Vec3> points_;
  std::vector<double> arc_;
};

std::vector<Vec3> checked_points(const geometry::Mesh& mesh, const std::vector<Vec3>& curve) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (!curve[i].allFinite()) throw InputError(fmt::format("point {} of the curve is not finite", i + 1));
    if (const double off = mesh.nearest(curve[i]).distance; off > kFarthest)
      throw InputError(
          fmt::format("point {} of the curve, {}, is {:.3f} mm from the part, more than {:.0f} mm", i + 1,
                      in_mm(curve[i]), to_mm(off), to_mm(kFarthest)));
    if (points.empty() || (curve[i] - points.back()).norm() > kFinest) points.push_back(curve[i]);
  }
  if (points.size() < 2)
    throw InputError(fmt::format("the curve has {} points apart from each other, it needs 2", points.size()));
  return points;
}

std::vector<Stretch> stretches_between_corners(const std::vector<Vec3>& points) {
  std::vector<Stretch> stretches(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    stretches.back().add(points[i]);
    const bool inner = i > 0 && i + 1 < points.size();
    if (!inner || angle(points[i] - points[i - 1], points[i + 1] - points[i]) <= kCorner) continue;
    stretches.emplace_back();
    stretches.back().add(points[i]);
  }
  return stretches;
}

class Sampler {
 public:
  Sampler(const geometry::Mesh& mesh, const SamplingLimits& limits) : mesh_(mesh), limits_(limits) {}

  void add(const Stretch& stretch) {
    const int parts = step_count(stretch.length() * (1 - 1e-9), limits_.step);
    SurfacePoint from = project(stretch.at(0));
    append(from);
    for (int i = 0; i < parts; ++i) {
      const double s = stretch.length() * i / parts, t = stretch.length() * (i + 1) / parts;
      const SurfacePoint to = project(stretch.at(t));
      refine(stretch, s, from, t, to);
      from = to;
    }
  }
  std::vector<SurfacePoint> take() { return std::move(samples_); }

 private:
  SurfacePoint project(const Vec3& p) const {
    const SurfacePoint point = mesh_.nearest(p);
    if (point.distance > kFarthest)
      throw InputError(fmt::format("the curve at {} is {:.3f} mm from the part, more than {:.0f} mm",
                                   in_mm(p), to_mm(point.distance), to_mm(kFarthest)));
    return point;
  }
  Vec3 tip(const SurfacePoint& point) const { return point.position + limits_.gap * point.normal; }

  // Appends what lies behind `from` up to `to`.
  void refine(const Stretch& stretch, double s, const SurfacePoint& from, double t, const SurfacePoint& to) {
    if (good(stretch, s, from, t, to)) return append(to);
    if (t - s < kFinest) {
      check_neighbours(from, to);
      return append(to);
    }
    const double middle = 0.5 * (s + t);
    const SurfacePoint between = project(stretch.at(middle));
    refine(stretch, s, from, middle, between);
    refine(stretch, middle, between, t, to);
  }

  bool good(const Stretch& stretch, double s, const SurfacePoint& from, double t,
            const SurfacePoint& to) const {
    // The surface may be longer than the curve above it, but less than a hair is no reason to halve a step.
    if ((to.position - from.position).norm() > 1.01 * limits_.step) return false;
    if (angle(from.normal, to.normal) > kSwingPerStep) return false;
    for (const double at : stretch.probes(s, t)) {
      const SurfacePoint probe = project(stretch.at(at));
      if (segment_distance(tip(probe), tip(from), tip(to)) > limits_.chord_tolerance) return false;
    }
    return true;
  }

  // At the finest step only a surface that breaks off is still not followed.
  void check_neighbours(const SurfacePoint& from, const SurfacePoint& to) const {
    const double turn = angle(from.normal, to.normal);
    if (turn > kSharpEdge)
      throw InputError(
          fmt::format("the curve crosses a sharp edge at {}: the normals of neighbours are {:.1f} deg "
                      "apart, more than {:.0f} deg",
                      in_mm(to.position), to_deg(turn), to_deg(kSharpEdge)));
    const double jump = (to.position - from.position).norm();
    if (jump > limits_.step)
      throw InputError(
          fmt::format("the surface under the curve jumps by {:.3f} mm at {}, more than a step of {:.3f} mm",
                      to_mm(jump), in_mm(to.position), to_mm(limits_.step)));
  }

  void append(const SurfacePoint& point) {
    const bool repeats =
        !samples_.empty() && (point.position - samples_.back().position).norm() < kFinest / 10;
    if (!repeats) samples_.push_back(point);
  }

  const geometry::Mesh& mesh_;
  SamplingLimits limits_;
  std::vector<SurfacePoint> samples_;
};

}  // namespace

std::vector<SurfacePoint> sample_curve(const geometry::Mesh& mesh, const std::vector<Vec3>& curve,
                                       const SamplingLimits& limits) {
  Sampler sampler(mesh, limits);
  for (const Stretch& stretch : stretches_between_corners(checked_points(mesh, curve))) sampler.add(stretch);
  std::vector<SurfacePoint> samples = sampler.take();
  if (samples.size() < 2) throw InputError("the curve has no length on the surface");
  return samples;
}

}  // namespace understudy::toolpath

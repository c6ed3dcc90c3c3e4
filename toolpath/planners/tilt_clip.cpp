#include "toolpath/planners/tilt_clip.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

class TiltClip {
 public:
  TiltClip(const geometry::Mesh& mesh, double low, double high, const Vec3& swing_axis)
      : mesh_(mesh), low_(low), high_(high), axis_(swing_axis) {}

  double tilt(const Vec3& p) const { return tilt_about(mesh_.nearest(p).normal, axis_); }
  bool within(double tilt) const { return tilt >= low_ && tilt <= high_; }

  struct Part {
    Vec3 from, to;
    bool reaches_end;
  };
  // The part of a segment that lies within the limits; the tilt is taken to be monotonic along it.
  std::optional<Part> part(const Vec3& p, const Vec3& q) const {
    const double tilt_p = tilt(p), tilt_q = tilt(q);
    if ((tilt_p < low_ && tilt_q < low_) || (tilt_p > high_ && tilt_q > high_)) return std::nullopt;
    Part part{p, q, within(tilt_q)};
    if (!within(tilt_p)) part.from = crossing(p, q, tilt_p < low_ ? low_ : high_);
    if (!within(tilt_q)) part.to = crossing(q, p, tilt_q < low_ ? low_ : high_);
    return part;
  }

 private:
  // Bisection from the end that lies outside to the one inside; the inner side is returned.
  Vec3 crossing(const Vec3& outside, const Vec3& inside, double limit) const {
    const bool outside_below = tilt(outside) < limit;
    double out = 0, in = 1;
    while (true) {
      const double middle = 0.5 * (out + in);
      if (middle <= out || middle >= in) break;
      const double t = tilt(outside + middle * (inside - outside));
      (outside_below ? t < limit : t > limit) ? out = middle : in = middle;
    }
    return outside + in * (inside - outside);
  }

  const geometry::Mesh& mesh_;
  double low_, high_;
  Vec3 axis_;
};

// A closed curve that begins inside the limits is turned to begin outside, lest its part be cut in two.
std::vector<Vec3> begun_outside(const TiltClip& clip, std::vector<Vec3> curve) {
  if (curve.size() < 3 || curve.front() != curve.back()) return curve;
  const auto outside =
      std::find_if(curve.begin(), curve.end(), [&](const Vec3& p) { return !clip.within(clip.tilt(p)); });
  if (outside == curve.end()) return curve;
  const auto shift = outside - curve.begin();
  curve.pop_back();
  std::rotate(curve.begin(), curve.begin() + shift, curve.end());
  curve.push_back(curve.front());
  return curve;
}

}  // namespace

double tilt_about(const Vec3& surface_normal, const Vec3& swing_axis) {
  return std::atan2(surface_normal.dot(swing_axis.cross(Vec3::UnitZ())), surface_normal.z());
}

std::vector<Vec3> clip_by_tilt(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, double tilt_min,
                               double tilt_max, const Vec3& swing_axis) {
  if (!(tilt_min < tilt_max))
    throw InputError(fmt::format("the lowest tilt is {:g} deg, it must be below the highest, {:g} deg",
                                 to_deg(tilt_min), to_deg(tilt_max)));
  const TiltClip clip(mesh, tilt_min, tilt_max, swing_axis);
  const std::vector<Vec3> points = begun_outside(clip, curve);
  std::vector<Vec3> longest, run;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto part = clip.part(points[i - 1], points[i]);
    if (part && run.empty()) run.push_back(part->from);
    if (part && part->to != run.back()) run.push_back(part->to);
    if (part && part->reaches_end && i + 1 < points.size()) continue;
    if (run.size() > 1 && polyline_length(run) > polyline_length(longest)) longest = run;
    run.clear();
  }
  if (longest.empty())
    throw InputError(
        fmt::format("no part of the curve tilts from {:g} to {:g} deg", to_deg(tilt_min), to_deg(tilt_max)));
  if (clip.tilt(longest.front()) > clip.tilt(longest.back())) std::reverse(longest.begin(), longest.end());
  return longest;
}

}  // namespace understudy::toolpath

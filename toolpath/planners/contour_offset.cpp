#include "toolpath/planners/contour_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kFound = 1 * kMicrometre;
// A mitre reaches as far as a polygon's own corner, but a needle's would leave the part.
constexpr double kLongestMitre = 4;

double segment_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double squared = along.squaredNorm();
  const double s = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return (a + s * along - p).norm();
}

Vec2 left(const Vec2& v) { return Vec2(-v.y(), v.x()); }

// Each corner to where the two moved sides meet.
Contour mitred(const Contour& contour, double offset) {
  Contour moved;
  const std::size_t count = contour.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 in = (contour[i] - contour[(i + count - 1) % count]).normalized();
    const Vec2 out = (contour[(i + 1) % count] - contour[i]).normalized();
    const Vec2 middle = left(in) + left(out);
    const double stretch = 2 / std::max(middle.squaredNorm(), 4 / (kLongestMitre * kLongestMitre));
    moved.push_back(contour[i] + offset * stretch * middle);
  }
  return moved;
}

// Cuts a closed polygon into the runs where `keep` holds.
class Cutter {
 public:
  Cutter(std::function<bool(const Vec2&)> keep, double spacing) : keep_(std::move(keep)), spacing_(spacing) {}

  std::vector<FlatPath> cut(const Contour& contour) {
    for (std::size_t i = 0; i < contour.size(); ++i) add_side(contour[i], contour[(i + 1) % contour.size()]);
    if (runs_.empty()) return {};
    // A run that was open at the first point goes on with what ended there.
    if (begun_inside_ && open_) {
      if (runs_.size() > 1) {
        FlatPath whole = runs_.back();
        whole.insert(whole.end(), runs_.front().begin() + 1, runs_.front().end());
        runs_.front() = std::move(whole);
        runs_.pop_back();
      }
    }
    return std::move(runs_);
  }

 private:
  void add_side(const Vec2& a, const Vec2& b) {
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing_)));
    if (first_) {
      first_ = false;
      begun_inside_ = open_ = keep_(a);
      if (open_) runs_.push_back({a});
    }
    for (int k = 1; k <= parts; ++k) {
      const Vec2 from = a + (b - a) * (k - 1) / parts, to = a + (b - a) * k / parts;
      const bool kept = keep_(to);
      if (kept && !open_) runs_.push_back({border(to, from)});
      if (!kept && open_) runs_.back().push_back(border(from, to));
      open_ = kept;
    }
    if (open_) runs_.back().push_back(b);
  }

  Vec2 border(Vec2 kept, Vec2 not_kept) const {
    while ((kept - not_kept).norm() > kFound) {
      const Vec2 middle = 0.5 * (kept + not_kept);
      (keep_(middle) ? kept : not_kept) = middle;
    }
    return kept;
  }

  std::function<bool(const Vec2&)> keep_;
  double spacing_;
  std::vector<FlatPath> runs_;
  bool first_ = true, begun_inside_ = false, open_ = false;
};

double length(const FlatPath& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

}  // namespace

Contour simplified(const Contour& contour, double tolerance) {
  Contour kept;
  for (const Vec2& p : contour)
    if (kept.empty() || (p - kept.back()).norm() > tolerance) kept.push_back(p);
  while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= tolerance) kept.pop_back();
  for (std::size_t i = 0; kept.size() > 3 && i < kept.size();) {
    const Vec2& before = kept[(i + kept.size() - 1) % kept.size()];
    const Vec2& after = kept[(i + 1) % kept.size()];
    if (segment_distance(kept[i], before, after) <= tolerance)
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return kept;
}

bool inside(const std::vector<Contour>& contours, const Vec2& p) {
  bool odd = false;
  for (const Contour& c : contours)
    for (std::size_t i = 0; i < c.size(); ++i) {
      const Vec2 &a = c[i], &b = c[(i + 1) % c.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
    }
  return odd;
}

double distance_to(const std::vector<Contour>& contours, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Contour& c : contours)
    for (std::size_t i = 0; i < c.size(); ++i)
      nearest = std::min(nearest, segment_distance(p, c[i], c[(i + 1) % c.size()]));
  return nearest;
}

std::vector<FlatPath> inset_paths(const std::vector<Contour>& contours, double offset, double shortest,
                                  const std::function<bool(const Vec2&)>& wanted) {
  const auto keep = [&](const Vec2& p) {
    return inside(contours, p) && distance_to(contours, p) >= offset - kFound && wanted(p);
  };
  std::vector<FlatPath> paths;
  for (const Contour& contour : contours) {
    if (contour.size() < 3) continue;
    for (FlatPath& run : Cutter(keep, 0.5 * offset).cut(mitred(contour, offset)))
      if (length(run) >= shortest) paths.push_back(std::move(run));
  }
  return paths;
}

}  // namespace understudy::toolpath

#include "toolpath/planners/contour_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <clipper.hpp>

#include "core/units.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr double kFound = 1 * kMicrometre;
// A mitre reaches as far as a polygon's own corner, but a needle's would leave the part.
constexpr double kLongestMitre = 4;

// Below 1.07 m Clipper needs no 128-bit products on this grid.
constexpr double kGrid = 1e-9;  // [m]

ClipperLib::Path on_grid(const Contour& contour) {
  ClipperLib::Path path;
  path.reserve(contour.size());
  for (const Vec2& p : contour) path.emplace_back(std::llround(p.x() / kGrid), std::llround(p.y() / kGrid));
  return path;
}

Contour off_grid(const ClipperLib::Path& path) {
  Contour contour;
  contour.reserve(path.size());
  for (const ClipperLib::IntPoint& p : path)
    contour.emplace_back(kGrid * static_cast<double>(p.X), kGrid * static_cast<double>(p.Y));
  return contour;
}

std::vector<Contour> shrunk(const std::vector<Contour>& contours, double offset) {
  ClipperLib::ClipperOffset clipper(kLongestMitre);
  for (const Contour& contour : contours)
    clipper.AddPath(on_grid(contour), ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  ClipperLib::Paths paths;
  clipper.Execute(paths, -offset / kGrid);
  std::vector<Contour> loops;
  for (const ClipperLib::Path& path : paths) loops.push_back(off_grid(path));
  return loops;
}

// Each loop from its point nearest to the first point of a contour on, in the order of the contours.
void begin_by_contours(std::vector<Contour>& loops, const std::vector<Contour>& contours) {
  struct Begun {
    std::size_t contour = 0;
    Contour loop;
  };
  std::vector<Begun> begun;
  for (Contour& loop : loops) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t of = 0, first = 0;
    for (std::size_t c = 0; c < contours.size(); ++c)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const double distance = (loop[i] - contours[c].front()).norm();
        if (distance < nearest) nearest = distance, of = c, first = i;
      }
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first), loop.end());
    begun.push_back({of, std::move(loop)});
  }
  std::stable_sort(begun.begin(), begun.end(),
                   [](const Begun& a, const Begun& b) { return a.contour < b.contour; });
  for (std::size_t i = 0; i < loops.size(); ++i) loops[i] = std::move(begun[i].loop);
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
    const int parts = step_count((b - a).norm(), spacing_);
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
  const ClipperLib::Path path = on_grid(contour);
  ClipperLib::Path kept;
  ClipperLib::CleanPolygon(path, kept, tolerance / kGrid);
  // CleanPolygon begins anywhere, and keeps either of two points within the tolerance: the contour begins at
  // its first point that is left, or at that one's neighbour.
  const auto near = [&](const ClipperLib::IntPoint& a, const ClipperLib::IntPoint& b) {
    return std::hypot(static_cast<double>(a.X - b.X), static_cast<double>(a.Y - b.Y)) <= tolerance / kGrid;
  };
  for (const ClipperLib::IntPoint& p : path) {
    const auto first =
        std::find_if(kept.begin(), kept.end(), [&](const ClipperLib::IntPoint& k) { return near(p, k); });
    if (first == kept.end()) continue;
    std::rotate(kept.begin(), first, kept.end());
    break;
  }
  return off_grid(kept);
}

std::vector<FlatPath> inset_paths(const std::vector<Contour>& contours, double offset, double shortest,
                                  const std::function<bool(const Vec2&)>& wanted) {
  std::vector<Contour> loops = shrunk(contours, offset);
  begin_by_contours(loops, contours);
  std::vector<FlatPath> paths;
  for (const Contour& loop : loops)
    for (FlatPath& run : Cutter(wanted, 0.5 * offset).cut(loop))
      if (length(run) >= shortest) paths.push_back(std::move(run));
  return paths;
}

}  // namespace understudy::toolpath

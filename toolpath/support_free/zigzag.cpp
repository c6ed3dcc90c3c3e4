#include "toolpath/support_free/zigzag.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr double kSmaller = 0.98;
constexpr double kInside = 1 * kMicrometre;  // from the border, where crossings are plain

Vec2 across(const Vec2& along) { return {-along.y(), along.x()}; }

BoundingRectangle rectangle_along(const Contour& contour, const Vec2& along) {
  const Vec2 side = across(along);
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec2& p : contour) {
    const Vec2 q(p.dot(along), p.dot(side));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const Vec2 size = high - low, middle = 0.5 * (low + high);
  return {middle.x() * along + middle.y() * side, along, size.x(), size.y()};
}

/// A piece of a scan line within the region.
struct Piece {
  double low = 0, high = 0;
  bool used = false;
};

class Scan {
 public:
  Scan(const std::vector<Contour>& region, const Vec2& along) : along_(along), side_(across(along)) {
    for (const Contour& contour : region)
      for (std::size_t i = 0; i < contour.size(); ++i)
        edges_.push_back({turned(contour[i]), turned(contour[(i + 1) % contour.size()])});
    for (const auto& [a, b] : edges_) low_ = std::min(low_, a.x()), high_ = std::max(high_, a.x());
  }

  double low() const { return low_; }
  double high() const { return high_; }
  Vec2 turned(const Vec2& p) const { return {p.dot(along_), p.dot(side_)}; }
  Vec2 back(double x, double y) const { return x * along_ + y * side_; }

  bool inside(const Vec2& turned) const {
    const auto pieces = pieces_at(turned.x());
    return std::ranges::any_of(
        pieces, [&](const Piece& piece) { return piece.low <= turned.y() && turned.y() <= piece.high; });
  }

  std::vector<Piece> pieces_at(double x) const {
    std::vector<double> crossings;
    for (const auto& [a, b] : edges_)
      if ((a.x() > x) != (b.x() > x))
        crossings.push_back(a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x()));
    std::sort(crossings.begin(), crossings.end());
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      pieces.push_back({crossings[i], crossings[i + 1]});
    return pieces;
  }

 private:
  Vec2 along_, side_;
  std::vector<std::pair<Vec2, Vec2>> edges_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// The nearest to where the path is by now, of those that face the piece just laid.
Piece* unused_beside(std::vector<Piece>& pieces, const Piece& piece, double end) {
  Piece* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Piece& next : pieces) {
    const double away = std::min(std::abs(next.low - end), std::abs(next.high - end));
    if (next.used || next.low >= piece.high || next.high <= piece.low || away >= least) continue;
    least = away;
    nearest = &next;
  }
  return nearest;
}

}  // namespace

BoundingRectangle bounding_rectangle(const Contour& contour, const Vec2& along) {
  BoundingRectangle best = rectangle_along(contour, along);
  double least = kSmaller * best.length * best.width;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 edge = contour[(i + 1) % contour.size()] - contour[i];
    if (edge.norm() < kInside) continue;
    const BoundingRectangle found = rectangle_along(contour, edge.normalized());
    if (found.length * found.width >= least) continue;
    least = found.length * found.width;
    best = found;
  }
  // Of an almost square one the side stays that was asked for.
  if (best.length < kSmaller * best.width) {
    std::swap(best.length, best.width);
    best.along = across(best.along);
  }
  if (best.along.dot(along) < 0) best.along = -best.along;
  return best;
}

std::vector<FlatPath> zigzag(const std::vector<Contour>& region, const Vec2& along, double pitch,
                             const Vec2& from, double& spacing) {
  const Scan scan(region, along);
  const double low = scan.low() + kInside, high = scan.high() - kInside;
  spacing = pitch;
  if (!(high > low)) return {};
  const int gaps = step_count(high - low - 1e-6 * pitch, pitch);
  spacing = (high - low) / gaps;
  const bool forwards = scan.turned(from).x() - low < high - scan.turned(from).x();
  std::vector<double> places;
  std::vector<std::vector<Piece>> lines;
  for (int i = 0; i <= gaps; ++i) {
    places.push_back(forwards ? low + i * spacing : high - i * spacing);
    lines.push_back(scan.pieces_at(places.back()));
  }
  std::vector<FlatPath> paths;
  Vec2 end = scan.turned(from);
  for (std::size_t first = 0; first < lines.size(); ++first)
    for (Piece& begin : lines[first]) {
      if (begin.used) continue;
      FlatPath path;
      Piece* piece = &begin;
      for (std::size_t i = first; piece != nullptr;) {
        // From the end that is nearer to where the path is by now; not across what is no part of the region.
        const bool up = std::abs(piece->low - end.y()) <= std::abs(piece->high - end.y());
        const Vec2 begin_at(places[i], up ? piece->low : piece->high);
        if (!path.empty() && !scan.inside(0.5 * (begin_at + end))) break;
        piece->used = true;
        path.push_back(scan.back(begin_at.x(), begin_at.y()));
        path.push_back(scan.back(places[i], up ? piece->high : piece->low));
        end = {places[i], up ? piece->high : piece->low};
        const Piece done = *piece;
        piece = ++i < lines.size() ? unused_beside(lines[i], done, end.y()) : nullptr;
      }
      paths.push_back(std::move(path));
    }
  return paths;
}

}  // namespace understudy::toolpath

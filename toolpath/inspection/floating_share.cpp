#include "toolpath/inspection/floating_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/quantile.h"

namespace understudy::toolpath {
namespace {

constexpr double kReach = 2e-3;          // [m], and a cell: where nothing is as near, the place floats
constexpr double kOwnPath = 6e-3;        // [m], that was printed just now holds nothing
constexpr double kSpacing = 0.5e-3;      // [m], of points along the path, or
constexpr double kMostPoints = 200'000;  // wider
constexpr std::size_t kMostPlaces = 5000;
constexpr double kFar = 3;  // usual distances

struct Point {
  Vec3 place_W;
  double path;  // [m], printed up to there
};

/// Calls `visit` with start, way [m] and length [m] of each printed move.
template <typename Visit>
void visit_printed(const Program& program, const Vec3& start_W, Visit visit) {
  Vec3 tip_W = start_W;
  for (const Step& step : program.steps) {
    if (!moves(step)) continue;
    const Vec3 from_W = tip_W, way_W = step.X_WT.translation() - tip_W;
    tip_W = step.X_WT.translation();
    const double length = way_W.norm();
    if (step.kind == StepKind::print && length > 0 && std::isfinite(length)) visit(from_W, way_W, length);
  }
}

/// Evenly spaced along what is printed.
std::vector<Point> printed_points(const Program& program, const Vec3& start_W) {
  double printed = 0;
  visit_printed(program, start_W, [&](const Vec3&, const Vec3&, double length) { printed += length; });
  const double spacing = std::max(kSpacing, printed / kMostPoints);
  std::vector<Point> points;
  double path = 0, next = 0;
  visit_printed(program, start_W, [&](const Vec3& from_W, const Vec3& way_W, double length) {
    for (; next < path + length; next += spacing)
      points.push_back({from_W + (next - path) / length * way_W, next});
    path += length;
  });
  return points;
}

/// Points by cells of kReach; the nearest of those that are farther back on the path than kOwnPath.
class EarlierPoints {
 public:
  void add(const Point& point) { cells_[key(cell_of(point.place_W))].push_back(point); }

  double nearest(const Point& point) const {
    double least = kReach;
    const Cell middle = cell_of(point.place_W);
    for (int k = 0; k < 27; ++k) {
      const auto cell =
          cells_.find(key({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1}));
      if (cell == cells_.end()) continue;
      for (const Point& other : cell->second) {
        if (other.path > point.path - kOwnPath) break;  // they are in order
        least = std::min(least, (other.place_W - point.place_W).norm());
      }
    }
    return least;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static Cell cell_of(const Vec3& place_W) {
    Cell cell;
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(place_W[i] / kReach));
    return cell;
  }
  static std::int64_t key(const Cell& cell) {
    constexpr std::int64_t kRow = 1 << 20;  // 2 km
    return (cell[0] * kRow + cell[1]) * kRow + cell[2];
  }

  std::unordered_map<std::int64_t, std::vector<Point>> cells_;
};

}  // namespace

double floating_share(const Program& program, const Vec3& start_W) {
  const std::vector<Point> points = printed_points(program, start_W);
  if (points.empty()) return 0;
  const auto lower = [](const Point& a, const Point& b) { return a.place_W.z() < b.place_W.z(); };
  const double ground = std::min_element(points.begin(), points.end(), lower)->place_W.z();
  EarlierPoints earlier;
  std::vector<double> distances;
  const std::size_t stride = points.size() / kMostPlaces + 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % stride == 0)
      distances.push_back(std::min(earlier.nearest(points[i]), points[i].place_W.z() - ground));
    earlier.add(points[i]);
  }
  const double far = std::min(kReach, kFar * std::max(quantile(distances, 0.5), kSpacing));
  const auto floats = [&](double distance) { return distance >= far; };
  return static_cast<double>(std::count_if(distances.begin(), distances.end(), floats)) /
         static_cast<double>(distances.size());
}

}  // namespace understudy::toolpath

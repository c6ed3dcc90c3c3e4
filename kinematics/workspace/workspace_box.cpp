// The largest cube and the largest box in the reachable points.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinematics/workspace/workspace.h"

namespace understudy::kinematics {
namespace {

/// Points that end at `last` from the grid's middle, doubled to stay whole.
std::int64_t off_centre(const std::array<int, 3>& n, const std::array<int, 3>& last, int side) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t twice = 2 * last[i] - (side - 1) - (n[i] - 1);
    sum += twice * twice;
  }
  return sum;
}

struct Rectangle {
  int x_first = 0, x_last = -1, y_first = 0, y_last = -1;
  std::int64_t area() const { return std::int64_t{x_last - x_first + 1} * (y_last - y_first + 1); }
};

/// Largest rectangle under the bars of one row, each `height` points high up to row y; with a stack of bars
/// that rise.
void widen(const std::vector<int>& height, int y, std::vector<int>& rising, Rectangle& best) {
  const int n = static_cast<int>(height.size());
  rising.clear();
  for (int x = 0; x <= n; ++x) {
    const int here = x < n ? height[x] : 0;
    while (!rising.empty() && height[rising.back()] >= here) {
      const int bar = height[rising.back()];
      rising.pop_back();
      const Rectangle r{rising.empty() ? 0 : rising.back() + 1, x - 1, y - bar + 1, y};
      if (bar > 0 && r.area() > best.area()) best = r;
    }
    rising.push_back(x);
  }
}

/// In a mask of n[0] x n[1] points.
class RectangleSearch {
 public:
  explicit RectangleSearch(const std::array<int, 3>& n) : n_(n), height_(n[0]) {}
  Rectangle largest(const std::vector<bool>& mask) {
    Rectangle best;
    std::fill(height_.begin(), height_.end(), 0);
    for (int y = 0; y < n_[1]; ++y) {
      for (int x = 0; x < n_[0]; ++x) {
        int& bar = height_[x];
        bar = mask[std::int64_t{y} * n_[0] + x] ? bar + 1 : 0;
      }
      widen(height_, y, rising_, best);
    }
    return best;
  }

 private:
  std::array<int, 3> n_;
  std::vector<int> height_, rising_;
};

}  // namespace

// The cube that ends at a point is one larger than the smallest of those that end at its seven neighbours
// below.
std::optional<PointBox> largest_cube(const Workspace& workspace) {
  const auto n = workspace.grid.cells();
  const std::int64_t layer = std::int64_t{n[0] + 1} * (n[1] + 1);
  std::vector<int> below(layer, 0), here(layer, 0);
  std::array<int, 3> best_last{};
  int best = 0;
  for (int z = 0; z < n[2]; ++z) {
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        const std::size_t i = std::int64_t{y + 1} * (n[0] + 1) + x + 1, up = i - (n[0] + 1);
        here[i] = workspace.reaches(x, y, z) ? 1 + std::min({here[i - 1], here[up], here[up - 1], below[i],
                                                             below[i - 1], below[up], below[up - 1]})
                                             : 0;
        const std::array<int, 3> last{x, y, z};
        if (here[i] < best || here[i] == 0) continue;
        if (here[i] == best && off_centre(n, last, best) >= off_centre(n, best_last, best)) continue;
        best = here[i];
        best_last = last;
      }
    }
    here.swap(below);
  }
  if (best == 0) return std::nullopt;
  return PointBox{{best_last[0] - best + 1, best_last[1] - best + 1, best_last[2] - best + 1}, best_last};
}

// For every lowest layer the points that all layers above it share can only become fewer, which also bounds
// what taller boxes can hold.
std::optional<PointBox> largest_box(const Workspace& workspace) {
  const auto n = workspace.grid.cells();
  RectangleSearch search(n);
  std::int64_t best = 0;
  PointBox box;
  for (int z_first = 0; z_first < n[2]; ++z_first) {
    std::vector<bool> mask(std::int64_t{n[0]} * n[1], true);
    for (int z = z_first; z < n[2]; ++z) {
      const std::size_t first = workspace.index(0, 0, z);
      for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] && workspace.binding[first + i] == 0;
      const Rectangle r = search.largest(mask);
      if (r.area() * (n[2] - z_first) <= best) break;
      if (r.area() * (z - z_first + 1) <= best) continue;
      best = r.area() * (z - z_first + 1);
      box = {{r.x_first, r.y_first, z_first}, {r.x_last, r.y_last, z}};
    }
  }
  if (best == 0) return std::nullopt;
  return box;
}

std::vector<double> reachable_quantiles(const Workspace& workspace, const std::vector<float>& values) {
  std::vector<float> sorted;
  sorted.reserve(workspace.reachable);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (workspace.binding[i] == 0) sorted.push_back(values[i]);
  std::vector<double> quantiles;
  if (sorted.empty()) return quantiles;
  std::sort(sorted.begin(), sorted.end());
  for (const double share : kWorkspaceQuantiles)
    quantiles.push_back(sorted[std::llround(share * static_cast<double>(sorted.size() - 1))]);
  return quantiles;
}

}  // namespace understudy::kinematics

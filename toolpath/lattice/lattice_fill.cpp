#include "toolpath/lattice/lattice_fill.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "core/error.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr double kOnSurface = 1 * kMicrometre;  // single precision of an STL of some decimetres
constexpr double kNodesMax = 100'000;           // docs/limits.md
constexpr double kLargest = 2.0;                // [m], of a part; more smells of a wrong unit

void check_strut(double strut) {
  check_within("strut length", to_mm(strut), to_mm(kShortestStrut), to_mm(kLongestStrut), "mm");
}

// A grid of nodes, of which some are within the part.
class CubeGrid {
 public:
  CubeGrid(const Vec3& lower, const Vec3& upper, double strut) : strut_(strut) {
    const Vec3 size = upper - lower;
    for (int k = 0; k < 3; ++k) {
      cubes_[k] = static_cast<int>(std::floor((size[k] + kOnSurface) / strut));
      const double left = size[k] - cubes_[k] * strut;
      origin_[k] = lower[k] + (k < 2 ? 0.5 * left : 0);
    }
    const double nodes = 1.0 * count(0) * count(1) * count(2);
    if (nodes > kNodesMax)
      throw InputError(fmt::format(
          "a lattice of {:.3g} nodes, more than {:g}: longer struts, or a smaller part", nodes, kNodesMax));
  }

  using Inside = std::function<bool(const Vec3&)>;
  LatticeFill fill(const Inside& inside) const {
    Lattice all;
    std::vector<int> index(count(0) * count(1) * count(2), -1);
    for (int n = 0; n < static_cast<int>(index.size()); ++n) {
      const Vec3 p = node(n);
      if (!inside(p)) continue;
      index[n] = static_cast<int>(all.nodes.size());
      all.nodes.push_back({p, n < count(0) * count(1)});
    }
    const int stride[] = {1, count(0), count(0) * count(1)};
    for (int n = 0; n < static_cast<int>(index.size()); ++n)
      for (int k = 0; k < 3; ++k) {
        if (n / stride[k] % count(k) + 1 >= count(k)) continue;
        const int a = index[n], b = index[n + stride[k]];
        if (a >= 0 && b >= 0 && inside(0.5 * (node(n) + node(n + stride[k])))) all.struts.push_back({a, b});
      }
    return connected(all);
  }

 private:
  int count(int k) const { return cubes_[k] + 1; }
  Vec3 node(int n) const {
    const int x = n % count(0), y = n / count(0) % count(1), z = n / (count(0) * count(1));
    return origin_ + strut_ * Vec3(x, y, z);
  }

  // Without what no strut connects to the table.
  static LatticeFill connected(const Lattice& all) {
    std::vector<bool> keep(all.nodes.size());
    for (const auto& [a, b] : all.struts) keep[a] = keep[b] = true;
    for (const int n : hanging_nodes(all)) keep[n] = false;
    LatticeFill result;
    std::vector<int> index(all.nodes.size(), -1);
    for (std::size_t n = 0; n < all.nodes.size(); ++n) {
      if (!keep[n]) {
        ++result.dropped;
        continue;
      }
      index[n] = static_cast<int>(result.lattice.nodes.size());
      result.lattice.nodes.push_back(all.nodes[n]);
    }
    for (const auto& [a, b] : all.struts)
      if (keep[a] && keep[b]) result.lattice.struts.push_back({index[a], index[b]});
    return result;
  }

  double strut_;
  Vec3 origin_;
  int cubes_[3] = {};
};

LatticeFill checked(LatticeFill fill, const Vec3& size, double strut) {
  if (fill.lattice.struts.empty())
    throw InputError(
        fmt::format("a part of {:g} x {:g} x {:g} mm has no room on the table for a strut of {:g} mm",
                    to_mm(size.x()), to_mm(size.y()), to_mm(size.z()), to_mm(strut)));
  return fill;
}

}  // namespace

LatticeFill fill_part(const geometry::Mesh& part, double strut) {
  check_strut(strut);
  if (part.open_edges() > 0)
    throw InputError(
        fmt::format("the part has {} open edges, a part to fill must have 0", part.open_edges()));
  const CubeGrid grid(part.lower(), part.upper(), strut);
  const auto inside = [&](const Vec3& p) { return part.signed_distance(p) <= kOnSurface; };
  return checked(grid.fill(inside), part.upper() - part.lower(), strut);
}

LatticeFill fill_box(const Vec3& size, double strut) {
  check_strut(strut);
  for (int k = 0; k < 3; ++k)
    if (!(size[k] > 0 && size[k] <= kLargest))
      throw InputError(fmt::format("side {} of the box is {:g} mm, outside 0 to {:g} mm", k + 1,
                                   to_mm(size[k]), to_mm(kLargest)));
  const Vec3 lower(-0.5 * size.x(), -0.5 * size.y(), 0);
  const CubeGrid grid(lower, lower + size, strut);
  return checked(grid.fill([](const Vec3&) { return true; }), size, strut);
}

}  // namespace understudy::toolpath

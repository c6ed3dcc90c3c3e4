// Parts of equal cubes.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy {

using Cubes = std::set<std::array<int, 3>>;

/// Adds those from the lower to before the upper corner.
inline void add_block(Cubes& cubes, const std::array<int, 3>& lower, const std::array<int, 3>& upper) {
  for (int i = lower[0]; i < upper[0]; ++i)
    for (int j = lower[1]; j < upper[1]; ++j)
      for (int k = lower[2]; k < upper[2]; ++k) cubes.insert({i, j, k});
}

/// The surface of cubes of `side_mm`; closed where no two of them share an edge only.
inline std::shared_ptr<const geometry::Mesh> block_part(const Cubes& cubes, double side_mm) {
  std::map<std::array<int, 3>, int> index;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [it, is_new] = index.try_emplace(c, static_cast<int>(vertices.size()));
    if (is_new) vertices.push_back(from_mm(side_mm) * Vec3(c[0], c[1], c[2]));
    return it->second;
  };
  for (const auto& cube : cubes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        auto neighbour = cube;
        neighbour[axis] += side ? 1 : -1;
        if (cubes.contains(neighbour)) continue;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<int, 4> quad{};
        for (std::size_t n = 0; n < 4; ++n) {
          auto corner = cube;
          corner[axis] += side;
          corner[u] += n == 1 || n == 2;
          corner[v] += n >= 2;
          quad[side ? n : 3 - n] = vertex(corner);
        }
        triangles.push_back({quad[0], quad[1], quad[2]});
        triangles.push_back({quad[0], quad[2], quad[3]});
      }
  return std::make_shared<geometry::Mesh>(std::move(vertices), std::move(triangles));
}

/// For the lattice in five directions (Ishak 2018): a column of 5 x 5 x 40 mm with an arm of 10 mm on each
/// side, at its top, where a tool that lies on its side has room above the table.
inline Cubes column_with_arms() {
  Cubes cubes;
  add_block(cubes, {0, 0, 0}, {1, 1, 8});
  add_block(cubes, {0, -2, 7}, {1, 3, 8});
  add_block(cubes, {-2, 0, 7}, {3, 1, 8});
  return cubes;
}

}  // namespace understudy

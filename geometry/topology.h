// Which triangles of an indexed mesh meet at which edge.
#pragma once

#include <array>
#include <vector>

namespace understudy::geometry {

struct Topology {
  std::vector<std::array<int, 3>> neighbours;  ///< across edge k -> k + 1; -1 unless exactly two meet there
  int open_edges = 0;                          ///< edges of one triangle, or of more than two
  int flipped_edges = 0;                       ///< edges that their two triangles run along in one direction
};

Topology find_topology(const std::vector<std::array<int, 3>>& triangles);

}  // namespace understudy::geometry

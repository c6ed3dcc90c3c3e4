#include "geometry/topology.h"

#include <algorithm>
#include <tuple>

namespace understudy::geometry {
namespace {

struct HalfEdge {
  int low, high;  // vertices, low < high
  int triangle, side;
  bool rising;  // runs from low to high
  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][static_cast<std::size_t>(k)];
      const int b = triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), k, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.low, l.high, l.triangle, l.side) < std::tie(r.low, r.high, r.triangle, r.side);
  });
  return edges;
}

}  // namespace

Topology find_topology(const std::vector<std::array<int, 3>>& triangles) {
  Topology topology;
  topology.neighbours.assign(triangles.size(), {-1, -1, -1});
  const auto neighbour = [&](const HalfEdge& edge) -> int& {
    return topology.neighbours[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)];
  };
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t end = first + 1;
    while (end < edges.size() && edges[end].same_edge(edges[first])) ++end;
    if (end - first == 2) {
      const HalfEdge &one = edges[first], &other = edges[first + 1];
      neighbour(one) = other.triangle;
      neighbour(other) = one.triangle;
      if (one.rising == other.rising) ++topology.flipped_edges;
    } else {
      ++topology.open_edges;
    }
    first = end;
  }
  return topology;
}

}  // namespace understudy::geometry

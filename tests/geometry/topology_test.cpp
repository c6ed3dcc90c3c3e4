#include "geometry/topology.h"

#include <gtest/gtest.h>

#include "tests/geometry/test_solids.h"

namespace understudy::geometry {
namespace {

TEST(Topology, ALoneTriangleHasThreeOpenEdges) {
  const Topology t = find_topology({{0, 1, 2}});
  EXPECT_EQ(t.open_edges, 3);
  EXPECT_EQ(t.flipped_edges, 0);
  EXPECT_EQ(t.neighbours[0], (std::array<int, 3>{-1, -1, -1}));
}

TEST(Topology, NeighboursAreAcrossTheEdgeThatTheyShare) {
  const Topology t = find_topology({{0, 1, 2}, {2, 1, 3}});
  EXPECT_EQ(t.neighbours[0], (std::array<int, 3>{-1, 1, -1})) << "edge 1 -> 2";
  EXPECT_EQ(t.neighbours[1], (std::array<int, 3>{0, -1, -1})) << "edge 2 -> 1";
  EXPECT_EQ(t.open_edges, 4);
}

TEST(Topology, TrianglesThatWindAgainstEachOtherFlipTheirEdge) {
  EXPECT_EQ(find_topology({{0, 1, 2}, {1, 2, 3}}).flipped_edges, 1);
  EXPECT_EQ(find_topology({{0, 1, 2}, {2, 1, 3}}).flipped_edges, 0);
}

TEST(Topology, AnEdgeOfThreeTrianglesIsOpenAndHasNoNeighbours) {
  const Topology t = find_topology({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  for (const auto& of : t.neighbours) EXPECT_EQ(of[0], -1);
  EXPECT_EQ(t.open_edges, 6 + 1);
}

TEST(Topology, OfAClosedSolidIsClosedAndSymmetric) {
  const Triangles solid = sphere(1, 12, 24);
  const Topology t = find_topology(solid.triangles);
  EXPECT_EQ(t.open_edges, 0);
  EXPECT_EQ(t.flipped_edges, 0);
  for (std::size_t i = 0; i < t.neighbours.size(); ++i)
    for (const int other : t.neighbours[i]) {
      const auto& back = t.neighbours[static_cast<std::size_t>(other)];
      EXPECT_EQ(std::count(back.begin(), back.end(), static_cast<int>(i)), 1);
    }
}

}  // namespace
}  // namespace understudy::geometry

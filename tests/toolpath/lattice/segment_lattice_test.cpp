#include "toolpath/lattice/segment_lattice.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/units.h"
#include "models/parts/block_part.h"

namespace understudy::toolpath {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

SegmentLattice column() { return segment_lattice(segment_part(*block_part(column_with_arms(), 5), 5e-3)); }

// By hand: a column of 8 cubes has 36 nodes, 9 squares of 4 struts and 8 x 4 upright ones; an arm of 2 cubes
// adds 8 nodes and 2 x (4 + 4) struts and shares the column's square.
TEST(SegmentLattice, AColumnWithFourArmsHasTheStrutsCountedByHand) {
  const SegmentLattice lattice = column();
  EXPECT_EQ(lattice.lattice.nodes.size(), 36u + 4u * 8u);
  EXPECT_EQ(lattice.lattice.struts.size(), 68u + 4u * 16u);
  ASSERT_EQ(lattice.segments.size(), 5u);
  EXPECT_EQ(lattice.segments[0].struts.size(), 68u);
  for (std::size_t s = 1; s < 5; ++s) EXPECT_EQ(lattice.segments[s].struts.size(), 16u);
  std::set<std::pair<int, int>> once;
  for (const auto& [a, b] : lattice.lattice.struts) EXPECT_TRUE(once.insert(std::minmax(a, b)).second);
}

// Layer by layer along the build direction; each strut begins where something stands, a rising one ends
// higher.
TEST(SegmentLattice, StrutsComeLayerByLayerAlongTheBuildDirection) {
  const SegmentLattice lattice = column();
  std::set<int> there;
  for (std::size_t n = 0; n < lattice.lattice.nodes.size(); ++n)
    if (lattice.lattice.nodes[n].grounded) there.insert(static_cast<int>(n));
  EXPECT_EQ(there.size(), 4u);
  for (const SegmentOrder& segment : lattice.segments) {
    double layer = -1;
    bool grid = false;
    for (const Removal& strut : segment.struts) {
      const double from = segment.axis.dot(lattice.lattice.nodes[at(strut.from)].position);
      const double to = segment.axis.dot(lattice.lattice.nodes[at(strut.to)].position);
      EXPECT_TRUE(there.contains(strut.from));
      there.insert(strut.to);
      const bool rises = to - from > 4.9e-3;
      EXPECT_TRUE(rises || std::abs(to - from) < 1e-9);
      EXPECT_GE(to, layer - 1e-9);
      EXPECT_FALSE(to < layer + 1e-9 && rises && grid) << "a strut rises after its grid";
      layer = to;
      grid = !rises;
    }
  }
}

TEST(SegmentLattice, TurnsWithItsAxes) {
  SegmentLattice lattice = column();
  const Vec3 before = lattice.lattice.nodes.back().position;
  turn(lattice, 90 * kDegree);
  EXPECT_NEAR((lattice.segments[1].axis - Vec3::UnitX()).norm(), 0, 1e-15);  // Y- becomes X+
  EXPECT_NEAR((lattice.lattice.nodes.back().position - Vec3(-before.y(), before.x(), before.z())).norm(), 0,
              1e-15);
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/lattice/lattice.h"

#include <gtest/gtest.h>

#include "toolpath/lattice/lattice_fill.h"

namespace understudy::toolpath {
namespace {

TEST(Lattice, PlacingScalesAndStandsItWhereAsked) {
  Lattice lattice = fill_box(Vec3(20e-3, 20e-3, 10e-3), 5e-3).lattice;
  for (LatticeNode& n : lattice.nodes) n.position += Vec3(0.3, 0.1, -0.7);
  place_lattice(lattice, 2, Vec3(1e-3, 2e-3, 3e-3));
  Eigen::AlignedBox3d box;
  for (const LatticeNode& n : lattice.nodes) box.extend(n.position);
  EXPECT_LT((box.min() - Vec3(-19e-3, -18e-3, 3e-3)).norm(), 1e-12);
  EXPECT_LT((box.max() - Vec3(21e-3, 22e-3, 23e-3)).norm(), 1e-12);
}

TEST(Lattice, NodesHangThatNoStrutConnectsToAGroundedOne) {
  Lattice lattice;
  lattice.nodes = {
      {Vec3(0, 0, 0), true}, {Vec3(0, 0, 0.01)}, {Vec3(1, 0, 0)}, {Vec3(1, 0, 0.01)}, {Vec3(2, 0, 0)}};
  lattice.struts = {{0, 1}, {3, 2}};
  EXPECT_EQ(hanging_nodes(lattice), (std::vector<int>{2, 3})) << "node 4 has no strut";
  lattice.struts.push_back({1, 3});
  EXPECT_TRUE(hanging_nodes(lattice).empty());
}

}  // namespace
}  // namespace understudy::toolpath

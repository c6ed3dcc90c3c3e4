#include "toolpath/lattice/lattice_fill.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

// Nodes and struts of a grid of a x b x c cubes, counted.
std::size_t grid_nodes(int a, int b, int c) { return static_cast<std::size_t>((a + 1) * (b + 1) * (c + 1)); }
std::size_t grid_struts(int a, int b, int c) {
  return static_cast<std::size_t>(a * (b + 1) * (c + 1) + (a + 1) * b * (c + 1) + (a + 1) * (b + 1) * c);
}

TEST(LatticeFill, ABoxIsFilledWithAsManyCubesAsFitInTheMiddle) {
  const LatticeFill fill = fill_box(Vec3(21e-3, 20e-3, 16e-3), 5e-3);
  EXPECT_EQ(fill.lattice.nodes.size(), grid_nodes(4, 4, 3));
  EXPECT_EQ(fill.lattice.struts.size(), grid_struts(4, 4, 3));
  EXPECT_EQ(fill.dropped, 0);
  for (std::size_t s = 0; s < fill.lattice.struts.size(); ++s)
    EXPECT_NEAR(fill.lattice.length(s), 5e-3, 1e-15);
  double left = 1, right = -1;
  for (const LatticeNode& n : fill.lattice.nodes) {
    left = std::min(left, n.position.x());
    right = std::max(right, n.position.x());
    EXPECT_EQ(n.grounded, n.position.z() < 1e-9);
  }
  EXPECT_NEAR(left, -10e-3, 1e-15);
  EXPECT_NEAR(right, 10e-3, 1e-15);
}

TEST(LatticeFill, APartIsFilledToItsOverhangs) {
  // A T of two boxes that share a face: 10 x 10 x 10 mm below 30 x 10 x 5 mm, as one closed surface.
  const auto t = geometry::Triangles{
      {Vec3(-5, -5, 0), Vec3(5, -5, 0), Vec3(5, -5, 10), Vec3(15, -5, 10), Vec3(15, -5, 15),
       Vec3(-15, -5, 15), Vec3(-15, -5, 10), Vec3(-5, -5, 10), Vec3(-5, 5, 0), Vec3(5, 5, 0), Vec3(5, 5, 10),
       Vec3(15, 5, 10), Vec3(15, 5, 15), Vec3(-15, 5, 15), Vec3(-15, 5, 10), Vec3(-5, 5, 10)},
      {}};
  std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {0, 2, 7}, {7, 2, 5},
                                               {7, 5, 6}, {2, 3, 4}, {2, 4, 5}};
  for (std::size_t i = 0, front = triangles.size(); i < front; ++i)
    triangles.push_back({triangles[i][0] + 8, triangles[i][2] + 8, triangles[i][1] + 8});
  for (int i = 0; i < 8; ++i) {
    const int j = (i + 1) % 8;
    triangles.push_back({j, i, i + 8});
    triangles.push_back({j, i + 8, j + 8});
  }
  std::vector<Vec3> vertices = t.vertices;
  for (Vec3& v : vertices) v *= 1e-3;
  const geometry::Mesh mesh(vertices, triangles);
  ASSERT_EQ(mesh.open_edges(), 0);
  ASSERT_NEAR(mesh.volume() * 1e9, 1000 + 1500, 1e-6);
  const LatticeFill fill = fill_part(mesh, 5e-3);
  // Stem: 3 x 3 nodes at 0, 5, 10, 15 mm; arms: 2 x 3 more on each side at 10 and 15 mm.
  EXPECT_EQ(fill.lattice.nodes.size(), 4u * 9 + 2u * 2 * 6);
  // Grids of 2 x 2 x 2 cubes below and 6 x 2 x 1 above, whose struts at 10 mm on the stem are the same.
  EXPECT_EQ(fill.lattice.struts.size(), grid_struts(2, 2, 2) + grid_struts(6, 2, 1) - grid_struts(2, 2, 0));
  EXPECT_EQ(fill.dropped, 0);
  EXPECT_TRUE(hanging_nodes(fill.lattice).empty());
}

TEST(LatticeFill, StrutsOutsideThePapersRangeAndPartsWithoutRoomAreRefused) {
  const auto refusal = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  // Ishak 2018: 5 to 11 mm.
  EXPECT_EQ(refusal([] { fill_box(Vec3(0.02, 0.02, 0.02), 5e-3); }), "accepted");
  EXPECT_EQ(refusal([] { fill_box(Vec3(0.02, 0.02, 0.02), 11e-3); }), "accepted");
  EXPECT_THAT(refusal([] { fill_box(Vec3(0.02, 0.02, 0.02), 4.9e-3); }),
              HasSubstr("strut length is 4.9 mm, outside 5 to 11 mm"));
  EXPECT_THAT(refusal([] { fill_box(Vec3(0.02, 0.02, 0.02), 11.1e-3); }),
              HasSubstr("strut length is 11.1 mm"));
  EXPECT_THAT(refusal([] { fill_box(Vec3(0.02, 0.02, 0.02), std::nan("")); }),
              HasSubstr("strut length is nan"));
  EXPECT_THAT(refusal([] { fill_box(Vec3(0.02, -1, 0.02), 5e-3); }),
              HasSubstr("side 2 of the box is -1000 mm"));
  EXPECT_THAT(refusal([] { fill_box(Vec3(4e-3, 4e-3, 4e-3), 5e-3); }),
              HasSubstr("a part of 4 x 4 x 4 mm has no room on the table for a strut of 5 mm"));
  const auto box = geometry::box(Vec3(0, 0, 0), Vec3(0.02, 0.02, 0.02));
  auto open = box.triangles;
  open.pop_back();
  const geometry::Mesh mesh(box.vertices, open);
  EXPECT_THAT(refusal([&] { fill_part(mesh, 5e-3); }), HasSubstr("the part has 3 open edges"));
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/lattice/lattice.h"

#include <cmath>
#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

std::string node(double x, double z, int grounded, const std::string& more = "") {
  return "{\"point\": {\"X\": " + std::to_string(x) + ", \"Y\": 0, \"Z\": " + std::to_string(z) +
         "}, \"is_grounded\": " + std::to_string(grounded) + more + "}";
}

// Two posts and a beam.
struct FrameText {
  std::string unit = "\"millimeter\"";
  std::string nodes = node(0, 0, 1) + "," + node(10, 0, 1) + "," + node(0, 8, 0) + "," + node(10, 8, 0);
  std::string elements =
      "{\"end_node_ids\": [0, 2]}, {\"end_node_ids\": [1, 3]}, {\"end_node_ids\": [2, 3], \"layer_id\": 1}";
  std::string text() const {
    return "{\"unit\": " + unit + ", \"node_list\": [" + nodes + "], \"element_list\": [" + elements + "]}";
  }
};

std::string rejection(const std::string& text) {
  try {
    parse_lattice(text, "frame.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LatticeFile, GivesNodesAndStrutsInMetres) {
  const Lattice lattice = parse_lattice(FrameText{}.text(), "frame.json");
  ASSERT_EQ(lattice.nodes.size(), 4u);
  ASSERT_EQ(lattice.struts.size(), 3u);
  EXPECT_TRUE(lattice.nodes[1].grounded);
  EXPECT_FALSE(lattice.nodes[2].grounded);
  EXPECT_LT((lattice.nodes[3].position - Vec3(10e-3, 0, 8e-3)).norm(), 1e-15);
  EXPECT_NEAR(lattice.length(0), 8e-3, 1e-15);
  EXPECT_NEAR(lattice.length(2), 10e-3, 1e-15);
}

TEST(LatticeFile, KnowsFourUnitsAndNodesByTheirIds) {
  const std::map<std::string, double> units = {
      {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"meter", 1}, {"inch", 25.4e-3}};
  for (const auto& [unit, metres] : units) {
    FrameText frame;
    frame.unit = "\"" + unit + "\"";
    EXPECT_NEAR(parse_lattice(frame.text(), "f").length(0), 8 * metres, 1e-12) << unit;
  }
  FrameText frame;
  frame.nodes = node(0, 0, 1, ", \"node_id\": 70") + "," + node(0, 8, 0, ", \"node_id\": 7");
  frame.elements = "{\"end_node_ids\": [7, 70]}";
  const Lattice lattice = parse_lattice(frame.text(), "f");
  EXPECT_EQ(lattice.struts[0], (std::array<int, 2>{1, 0}));
}

TEST(LatticeFile, WhatIsWrongIsNamedWithFileElementValueAndLimit) {
  const auto broken = [](auto change) {
    FrameText frame;
    change(frame);
    return rejection(frame.text());
  };
  EXPECT_THAT(rejection("{\n\"unit\": ]"), HasSubstr("frame.json:2: is not JSON here"));
  EXPECT_THAT(rejection("[1]"), HasSubstr("frame.json: the file is not an object"));
  EXPECT_THAT(rejection("{}"), HasSubstr("the frame has no 'unit'"));
  EXPECT_THAT(broken([](FrameText& f) { f.unit = "\"cubit\""; }),
              HasSubstr("unit is 'cubit', it must be millimeter, centimeter, meter or inch"));
  EXPECT_THAT(broken([](FrameText& f) { f.unit = "3"; }), HasSubstr("'unit' that is not a text"));
  EXPECT_THAT(broken([](FrameText& f) { f.nodes = ""; }), HasSubstr("node_list is not a list with an entry"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements = ""; }), HasSubstr("element_list is not a list"));
  EXPECT_THAT(broken([](FrameText& f) { f.nodes += ", 4"; }), HasSubstr("node 4 is not an object"));
  EXPECT_THAT(broken([](FrameText& f) { f.nodes += ", {\"point\": {\"X\": 1}, \"is_grounded\": 0}"; }),
              HasSubstr("node 4 has no 'Y'"));
  EXPECT_THAT(broken([](FrameText& f) {
                f.nodes += ", {\"point\": {\"X\": \"1\", \"Y\": 0, \"Z\": 0}, \"is_grounded\": 0}";
              }),
              HasSubstr("node 4 has X \"1\", it must be a finite number"));
  EXPECT_THAT(broken([](FrameText& f) { f.nodes += "," + node(1, 1, 2); }),
              HasSubstr("node 4 has is_grounded 2, it must be 0 or 1"));
  EXPECT_THAT(broken([](FrameText& f) { f.nodes += "," + node(1, 1, 0, ", \"node_id\": 2"); }),
              HasSubstr("node 4 has the node_id 2 a second time"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements += ", {\"end_node_ids\": [0, 9]}"; }),
              HasSubstr("element 3 ends at node 9, which is not one of the 4 nodes"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements += ", {\"end_node_ids\": [0]}"; }),
              HasSubstr("element 3 has end_node_ids [0], it must be two nodes"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements += ", {\"end_node_ids\": [0, 1.5]}"; }),
              HasSubstr("is 1.5, it must be a whole number"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements += ", {\"end_node_ids\": [2, 0]}"; }),
              HasSubstr("element 3 joins two nodes a second time"));
  EXPECT_THAT(broken([](FrameText& f) { f.elements += ", {\"end_node_ids\": [1, 1]}"; }),
              HasSubstr("element 3 is 0 mm long"));
  EXPECT_THAT(broken([](FrameText& f) {
                f.nodes = node(0, 0, 0) + "," + node(10, 0, 0) + "," + node(0, 8, 0) + "," + node(10, 8, 0);
              }),
              HasSubstr("the frame has 0 grounded nodes, it needs 1"));
  EXPECT_THAT(broken([](FrameText& f) {
                f.nodes += "," + node(40, 8, 0) + "," + node(50, 8, 0);
                f.elements += ", {\"end_node_ids\": [4, 5]}";
              }),
              HasSubstr("node 4 and 1 more are not connected to a grounded node"));
  EXPECT_THROW(read_lattice("/nonexistent.json"), InputError);
}

TEST(LatticeFile, ReadsFramesOfOthers) {
  const std::filesystem::path folder = UNDERSTUDY_SOURCE_DIR "/../shared/data/lattices";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const Lattice four = read_lattice(folder / "four-frame.json");
  EXPECT_EQ(four.struts.size(), 4u);
  EXPECT_NEAR(four.length(2), std::hypot(20e-3, 20e-3), 1e-12);  // from (0, -20, 0) to (0, 0, 20)
  const Lattice large = read_lattice(folder / "topopt-100_S1_03-14-2019_w_layer.json");
  EXPECT_EQ(large.nodes.size(), 88u);
  EXPECT_EQ(large.struts.size(), 132u);
}

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

TEST(LatticeFill, PlacingScalesAndStandsItWhereAsked) {
  Lattice lattice = fill_box(Vec3(20e-3, 20e-3, 10e-3), 5e-3).lattice;
  for (LatticeNode& n : lattice.nodes) n.position += Vec3(0.3, 0.1, -0.7);
  place_lattice(lattice, 2, Vec3(1e-3, 2e-3, 3e-3));
  Eigen::AlignedBox3d box;
  for (const LatticeNode& n : lattice.nodes) box.extend(n.position);
  EXPECT_LT((box.min() - Vec3(-19e-3, -18e-3, 3e-3)).norm(), 1e-12);
  EXPECT_LT((box.max() - Vec3(21e-3, 22e-3, 23e-3)).norm(), 1e-12);
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/lattice/lattice_json.h"

#include <cmath>
#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

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

}  // namespace
}  // namespace understudy::toolpath

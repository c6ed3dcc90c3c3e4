#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Pose, SaysWhereTheAxesStandAndDrawsThem) {
  const Folder folder;
  const std::string picture = folder / "pose.png";
  const Outcome seen = understudy("pose --machine five-axis X10 Y0 Z40 B15 C90 -o " + picture);
  EXPECT_EQ(seen.status, 0) << seen.err;
  EXPECT_THAT(seen.out,
              StartsWith("five-axis: tip (10.000, 0.000, 40.000) mm, tool axis (0.000000, 0.258819, "
                         "0.965926), 15.00 deg from upright: good\n"));
  EXPECT_THAT(seen.out, ContainsRegex("b +15.000 deg +-120.0 .. 120.0 deg +105.000 deg"));
  EXPECT_THAT(seen.out, ContainsRegex("c +90.000 deg +endless"));
  EXPECT_THAT(seen.out, HasSubstr(" b -15.000 c 270.000\n"));
  EXPECT_THAT(read_file(picture), StartsWith("\x89PNG"));
}

TEST(Pose, WritesTheAnswerAsJson) {
  const Folder folder;
  const std::string file = folder / "pose.json";
  ASSERT_EQ(understudy("pose --machine five-axis X10 Y0 Z40 B15 C90 --json " + file).status, 0);
  const auto answer = nlohmann::json::parse(read_file(file));
  EXPECT_EQ(answer.at("good"), true);
  EXPECT_EQ(answer.at("tip_mm"), nlohmann::json({10.0, 0.0, 40.0}));
  EXPECT_EQ(answer.at("tool_axis").at(0), 0.0) << "no digits of the last bit";
  // B tilts about y and C turns the tilted axis by 90 degrees: (0, sin 15, cos 15).
  EXPECT_NEAR(answer.at("tool_axis").at(1), 0.258819045, 1e-9);
  EXPECT_EQ(answer.at("axes").at(3).at("axis"), "b");
  EXPECT_EQ(answer.at("axes").at(3).at("range"), nlohmann::json({-120.0, 120.0}));
  EXPECT_NEAR(answer.at("axes").at(4).at("position"), 90, 1e-6);
  EXPECT_FALSE(answer.at("axes").at(4).contains("range")) << "C turns without end";
  EXPECT_NEAR(answer.at("branches").at(0).at(3), -15, 1e-6);
  EXPECT_GT(answer.at("clearance").at("distance_mm"), 0);
}

TEST(Pose, AnUnreachablePoseHasNoAxesInItsJson) {
  const Folder folder;
  const std::string file = folder / "pose.json";
  ASSERT_EQ(understudy("pose --machine arm X5000 --json " + file).status, 1);
  const auto answer = nlohmann::json::parse(read_file(file));
  EXPECT_EQ(answer.at("good"), false);
  EXPECT_EQ(answer.at("status"), "unreachable");
  EXPECT_FALSE(answer.contains("axes"));
}

TEST(Pose, TakesAxesAsWell) {
  const Outcome seen = understudy("pose --machine five-axis --axes=-50,0,-20,90,0");
  EXPECT_THAT(seen.out,
              StartsWith("five-axis: tip (10.000, 0.000, 20.000) mm, tool axis (1.000000, 0.000000, "));
}

TEST(Pose, ALimitIsNo) {
  const Outcome seen = understudy("pose --machine five-axis X0 Z-30 B130");
  EXPECT_EQ(seen.status, 1);
  EXPECT_THAT(seen.out, AllOf(HasSubstr("no good"), HasSubstr("axis b is at 130.0 deg, above 120.0 deg")));
  EXPECT_EQ(understudy("pose --machine arm X5000").status, 1);
}

TEST(Pose, WhatIsNoPoseIsBadInput) {
  const Folder folder;
  for (const std::string& words :
       {std::string("X1.2.3"), std::string("--machine arm B5"), std::string("X1 --axes 1,2,3,4,5,6"),
        std::string("--axes 1,2"), std::string("X1 -o pose.jpg"), "X1 -o " + (folder / "none/p.png"),
        std::string("X1 --fixture none"), "X1 --json " + (folder / "none/p.json")}) {
    const Outcome seen = understudy("pose " + words);
    EXPECT_EQ(seen.status, 2) << words;
    EXPECT_EQ(seen.out, "") << words;
  }
}

}  // namespace
}  // namespace understudy::cli_test

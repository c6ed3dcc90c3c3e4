#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
        std::string("X1 --fixture none")}) {
    const Outcome seen = understudy("pose " + words);
    EXPECT_EQ(seen.status, 2) << words;
    EXPECT_EQ(seen.out, "") << words;
  }
}

}  // namespace
}  // namespace understudy::cli_test

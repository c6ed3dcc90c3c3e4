#include "toolpath/crowding.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

/// `count` moves to and fro on line 2 and after, each `step_mm` long.
Program to_and_fro(int count, double step_mm, const std::string& filament) {
  std::string text = "G21 G90 M83 G0 X0.5 Y-0.5 Z0.2\n";
  for (int i = 0; i < count; ++i)
    text += fmt::format("G1 X{} {} F600\n", 0.5 + (i % 2 ? 0 : step_mm), filament);
  return parse_gcode(text, "s.gcode", {});
}

TEST(Crowding, TenThousandMovesInACubicMillimetreAreNoPrint) {
  EXPECT_NO_THROW(check_crowding(to_and_fro(10'000, 0.1, "E0.001")));
  try {
    check_crowding(to_and_fro(10'001, 0.1, "E0.001"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("s.gcode:10002: more than 10000 moves"));
    EXPECT_THAT(error.what(), HasSubstr("from (0, -1, 0) mm on"));
  }
}

TEST(Crowding, OtherPlacesAndTravelDoNotCount) {
  EXPECT_NO_THROW(check_crowding(to_and_fro(19'999, 1, "E0.001"))) << "half of them end in each of two cells";
  EXPECT_NO_THROW(check_crowding(to_and_fro(20'000, 0.1, "")));
}

}  // namespace
}  // namespace understudy::toolpath

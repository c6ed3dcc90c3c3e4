#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/complaint.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kRounding = 1e-12;

// Klipper, "G-Codes", SAVE_GCODE_STATE: modes, shifts, percentages, feed and reading of E come back; the
// place with MOVE=1.
TEST(GcodeSavedState, BringsBackModesShiftsAndReadings) {
  const Program program = parse_gcode(
      "M83\nG1 X10 E1 F600\nSAVE_GCODE_STATE NAME=a\nM82\nG91\nM221 S50\nM220 S50\nG92 X0 E5\nG1 Z5 F1200\n"
      "RESTORE_GCODE_STATE NAME=a\nG1 X20 E2\n",
      "p.gcode", {});
  const Step& last = program.steps.back();
  EXPECT_LT((last.X_WT.translation() * 1e3 - Vec3(20, 0, 5)).norm(), kRounding);
  EXPECT_NEAR(last.filament, 2e-3, kRounding);
  EXPECT_NEAR(last.feed, 600 * kMillimetrePerMinute, kRounding);
  const Program absolute =
      parse_gcode("M82\nG1 X10 E1 F600\nSAVE_GCODE_STATE\nG1 E0.2\nG92 E0\nRESTORE_GCODE_STATE\nG1 X20 E2\n",
                  "p.gcode", {});
  EXPECT_NEAR(absolute.steps.back().filament, 1e-3, kRounding) << "the reading of E is the saved one";
}

TEST(GcodeSavedState, MoveGoesBackToThePlaceAtItsSpeed) {
  const Program program = parse_gcode(
      "G1 X10 Y5 F600\nSAVE_GCODE_STATE NAME=a\nG0 X50 Z9\nRESTORE_GCODE_STATE NAME=a MOVE=1 MOVE_SPEED=50\n",
      "p.gcode", {});
  EXPECT_LT((program.steps.back().X_WT.translation() * 1e3 - Vec3(10, 5, 0)).norm(), kRounding);
  EXPECT_NEAR(program.steps.back().feed, 0.05, kRounding);
  EXPECT_EQ(program.steps.back().line, 4);
}

TEST(GcodeSavedState, WhatWasNotSavedOrIsNoNumberIsRefused) {
  const auto refused = [](const std::string& text) {
    return complaint([&] { parse_gcode("G0 X1\n" + text, "p.gcode", {}); });
  };
  EXPECT_THAT(refused("RESTORE_GCODE_STATE NAME=b\n"),
              StartsWith("p.gcode:2: no SAVE_GCODE_STATE before it has the name 'b'"));
  EXPECT_THAT(refused("SAVE_GCODE_STATE\nRESTORE_GCODE_STATE MOVE=1 MOVE_SPEED=fast\n"),
              HasSubstr("MOVE_SPEED"));
  EXPECT_THAT(refused("SAVE_GCODE_STATE\nRESTORE_GCODE_STATE MOVE=1 MOVE_SPEED=0\n"), HasSubstr("above 0"));
}

}  // namespace
}  // namespace understudy::toolpath

// Expected values: LinuxCNC, "G10 L2 Set Coordinate System", "G10 L20" and "G53 Move in Machine Coordinates";
// RS274/NGC Interpreter, version 3 (NISTIR 6556), 3.5.10 and 3.5.12.
#include "toolpath/gcode/gcode_work_offsets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kRounding = 1e-12;  // [mm]: sums of decimal text in doubles

std::vector<Step> parse(const std::string& text, const GcodeOptions& options = {}) {
  return parse_gcode(text, "p.gcode", options).steps;
}

Vec3 last_mm(const std::string& text, const GcodeOptions& options = {}) {
  return parse(text, options).back().X_WT.translation() * 1e3;
}

std::string rejection(const std::string& text, const GcodeOptions& options = {}) {
  try {
    parse(text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WorkOffsets, G10L2SetsTheOriginThatG54ToG59Choose) {
  // The manual's example: the origin of the first system is moved in X and Y only.
  const std::string table = "G10 L2 P1 X3.5 Y17.2\nG10 L2 P2 X-10 Z5\nG10 L2 P9 Y100\n";
  EXPECT_LT((last_mm(table + "G0 X0 Y0 Z0") - Vec3(3.5, 17.2, 0)).norm(), kRounding) << "G54 is in use";
  EXPECT_LT((last_mm(table + "G54 G0 X1 Y1 Z1") - Vec3(4.5, 18.2, 1)).norm(), kRounding);
  EXPECT_LT((last_mm(table + "G55\nG0 X1 Y1 Z1") - Vec3(-9, 1, 6)).norm(), kRounding);
  EXPECT_LT((last_mm(table + "G56 G0 X1 Y1 Z1") - Vec3(1, 1, 1)).norm(), kRounding) << "never set";
  EXPECT_LT((last_mm(table + "G59.3 G0 X1 Y1 Z1") - Vec3(1, 101, 1)).norm(), kRounding);
  EXPECT_LT((last_mm("G20\nG10 L2 P6 X1\nG59 G0 X1 Y0") - Vec3(50.8, 0, 0)).norm(), kRounding);
}

TEST(WorkOffsets, ATableOfTheOffsetInUseCountsAtOnceAndMovesNothing) {
  EXPECT_LT((last_mm("G0 X1 Y1\nG10 L2 P0 X10\nG0 Y2") - Vec3(1, 2, 0)).norm(), kRounding);
  EXPECT_LT((last_mm("G0 X1 Y1\nG10 L2 P0 X10\nG0 X1") - Vec3(11, 1, 0)).norm(), kRounding);
  EXPECT_EQ(parse("G0 X1\nG10 L2 P1 X10\nG55\nG54\n").size(), 1u);
}

TEST(WorkOffsets, G10L20CallsThePresentPositionSo) {
  EXPECT_LT((last_mm("G0 X10 Y5\nG10 L20 P1 X1.5\nG0 X0") - Vec3(8.5, 5, 0)).norm(), kRounding);
  EXPECT_LT((last_mm("G0 X10\nG10 L20 P2 X0\nG55 G0 X1 Y0") - Vec3(11, 0, 0)).norm(), kRounding);
}

TEST(WorkOffsets, G92AddsToThemAndG28EndsItAlone) {
  // "If a G92 origin offset was in effect before G10 L2, it will continue to be in effect afterwards."
  EXPECT_LT((last_mm("G0 X10\nG92 X0\nG10 L2 P1 X100\nG0 X1") - Vec3(111, 0, 0)).norm(), kRounding);
  EXPECT_LT((last_mm("G10 L2 P1 X100\nG0 X10\nG92 X0\nG28\nG0 X1") - Vec3(101, 0, 0)).norm(), kRounding);
  EXPECT_LT((last_mm("G10 L2 P1 X100\nG0 X10\nG92 X0\nG28 X\nG0 X1") - Vec3(101, 0, 0)).norm(), kRounding);
}

TEST(WorkOffsets, G53MovesInMachineCoordinatesForOneLine) {
  const std::string shifted = "G10 L2 P1 X3 Y4 Z5\nG0 X1 Y1 Z1\nG92 X0 Y0 Z0\n";
  EXPECT_LT((last_mm(shifted + "G53 G0 X0 Y0 Z0") - Vec3(0, 0, 0)).norm(), kRounding);
  EXPECT_LT((last_mm(shifted + "G91\nG53 G0 X7 Z2") - Vec3(7, 5, 2)).norm(), kRounding)
      << "absolute in G91, too";
  EXPECT_LT((last_mm(shifted + "G53 G0 X0\nX1") - Vec3(5, 5, 6)).norm(), kRounding) << "not modal";
  const auto printed = parse("G1 F600\nG53 G1 X10 E1\n");
  EXPECT_EQ(printed.back().kind, StepKind::print);
  // All of a program stands elsewhere: its machine's coordinates, too.
  GcodeOptions placed;
  placed.offset_W = Vec3(0.1, 0, 0);
  EXPECT_LT((last_mm(shifted + "G53 G0 X0 Y0 Z0", placed) - Vec3(100, 0, 0)).norm(), kRounding);
  EXPECT_LT((last_mm("G10 L2 P1 X3\nG0 X1 Y0 Z0", placed) - Vec3(104, 0, 0)).norm(), kRounding);
}

TEST(WorkOffsets, WhatTheyDoNotMeanIsRefusedByName) {
  EXPECT_THAT(rejection("G0 X1\nG53 G2 X1 I1"), HasSubstr("'G53' goes with G0 and G1 alone"));
  EXPECT_THAT(rejection("G53"), HasSubstr("'G53' needs X Y Z of a G0 or G1"));
  EXPECT_THAT(rejection("G53 X1"), HasSubstr("before any G0 or G1"));
  EXPECT_THAT(rejection("G54 G55"), HasSubstr("cannot share a line"));
  EXPECT_THAT(rejection("G10 L1 P1 Z1"),
              StartsWith("p.gcode:1:1: 'L1' sets work offsets by L2 or L20 alone"));
  EXPECT_THAT(rejection("G10 L2 X1"), HasSubstr("needs P, a whole number from 0"));
  EXPECT_THAT(rejection("G10 L2 P10 X1"), HasSubstr("'P10' needs P"));
  EXPECT_THAT(rejection("G10 L2 P1.5 X1"), HasSubstr("'P1.5' needs P"));
  EXPECT_THAT(rejection("G91\nG10 L2 P1 X1"), HasSubstr("put G90 before it"));
  EXPECT_THAT(rejection("G10 L2 P1 R45"), HasSubstr("'G10' names none of X Y Z"));
  EXPECT_THAT(rejection("G10 L2 P1 X1 R45"), HasSubstr("'R45' belongs to no command"));
  EXPECT_THAT(rejection("G10 L2 P1 X200000"), HasSubstr("beyond 100000 mm"));
  EXPECT_THAT(rejection("G10 P1 X5"), HasSubstr("alone on its line, or G10 L2"));
}

}  // namespace
}  // namespace understudy::toolpath

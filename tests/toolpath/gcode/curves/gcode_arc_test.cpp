#include "toolpath/gcode/curves/gcode_arc.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

std::vector<Step> steps_of(const std::string& text) { return parse_gcode(text, "p.gcode", {}).steps; }

std::string rejection(const std::string& text, const GcodeOptions& options = {}) {
  try {
    parse_gcode(text, "p.gcode", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// [mm]
double length_of(const std::vector<Step>& steps) {
  double length = 0;
  for (std::size_t i = 1; i < steps.size(); ++i)
    length += to_mm((steps[i].X_WT.translation() - steps[i - 1].X_WT.translation()).norm());
  return length;
}

// The chords of a circle of 10 mm that lie 2 um inside are shorter than it by a third of 0.04 %.
TEST(GcodeArc, AQuarterAndAWholeCircleAreAsLongAsTheyAre) {
  const auto quarter = steps_of("G0 X10 Y0 Z5\nG3 X0 Y10 I-10 J0 F600\n");
  EXPECT_NEAR(length_of(quarter), 5 * kPi, 5 * kPi * 2e-4);
  const auto three_quarters = steps_of("G0 X10 Y0 Z5\nG2 X0 Y10 I-10 J0 F600\n");
  EXPECT_NEAR(length_of(three_quarters), 15 * kPi, 15 * kPi * 2e-4);
  const auto whole = steps_of("G0 X10 Y0 Z5\nG2 I-10 F600\n");
  EXPECT_NEAR(length_of(whole), 20 * kPi, 20 * kPi * 2e-4);
  const auto three_turns = steps_of("G0 X10 Y0 Z5\nG3 X10 Y0 I-10 P3 F600\n");
  EXPECT_NEAR(length_of(three_turns), 60 * kPi, 60 * kPi * 2e-4);
}

TEST(GcodeArc, EveryPointLiesOnTheCircleAndEveryChordNearIt) {
  const auto steps = steps_of("G0 X10 Y0 Z5\nG3 X-10 Y0 I-10 J0 F600\n");
  ASSERT_GT(steps.size(), 20u);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Vec3 a = steps[i - 1].X_WT.translation(), b = steps[i].X_WT.translation();
    EXPECT_NEAR(to_mm(b.head<2>().norm()), 10, 1e-9);
    EXPECT_GT(to_um(Vec3((a + b) / 2).head<2>().norm()), 10e3 - 2.001);
    EXPECT_GT(b.y(), -1e-12) << "counter-clockwise from +x to -x is above";
  }
  EXPECT_EQ(steps.back().X_WT.translation(), Vec3(-10e-3, 0, 5e-3));
}

TEST(GcodeArc, AHelixClimbsEvenlyAndSharesItsFilament) {
  const auto steps = steps_of("M83\nG0 X10 Y0 Z0\nG3 X-10 Y0 Z2 I-10 E1 F600\n");
  double filament = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Vec3 p = steps[i].X_WT.translation();
    filament += to_mm(steps[i].filament);
    EXPECT_NEAR(to_mm(p.z()), 2 * std::atan2(p.y(), p.x()) / kPi, 1e-9);
    EXPECT_EQ(steps[i].kind, StepKind::print);
    EXPECT_EQ(steps[i].line, 3);
  }
  EXPECT_NEAR(filament, 1, 1e-12);
}

TEST(GcodeArc, ARadiusTakesTheShorterWayAndABelowZeroTheLonger) {
  for (const auto& [words, turn] : {std::pair{"G3 X0 Y10 R10", 0.25}, std::pair{"G3 X0 Y10 R-10", 0.75},
                                    std::pair{"G2 X0 Y10 R10", 0.25}, std::pair{"G2 X0 Y10 R-10", 0.75}}) {
    const auto steps = steps_of(std::string("G0 X10 Y0 Z5\n") + words + " F600\n");
    EXPECT_NEAR(length_of(steps), turn * 20 * kPi, turn * 20 * kPi * 2e-4) << words;
  }
}

// Right-handed about +Y: from +Z to +X; about +X: from +Y to +Z.
TEST(GcodeArc, OtherPlanesAreRightHandedAboutTheirNormals) {
  const auto zx = steps_of("G18\nG0 X0 Y3 Z10\nG3 X10 Z0 K-10 F600\n");
  EXPECT_NEAR(length_of(zx), 5 * kPi, 5 * kPi * 2e-4);
  for (const Step& step : zx) EXPECT_EQ(step.X_WT.translation().y(), 3e-3);
  const auto yz = steps_of("G19\nG0 X3 Y10 Z0\nG3 Y0 Z10 J-10 F600\n");
  EXPECT_NEAR(length_of(yz), 5 * kPi, 5 * kPi * 2e-4);
}

TEST(GcodeArc, IsModalAndKeepsFeedTimeAndOrientation) {
  const auto steps = steps_of("G0 X10 Y0 Z5 I0.6 J0 K0.8\nG3 X0 Y10 I-10 F600\nX-10 Y0 I0 J-10\n");
  EXPECT_NEAR(length_of(steps), 10 * kPi, 10 * kPi * 2e-4);
  EXPECT_NEAR(tool_axis(steps.back().X_WT).x(), 0.6, 1e-12);
  EXPECT_NEAR(steps.back().feed, 0.01, 1e-12);
  double time = 0;
  for (const Step& step : steps_of("G0 X10 Y0 Z5\nG93\nG3 X0 Y10 I-10 F2\n")) time += step.duration;
  EXPECT_NEAR(time, 30, 1e-9);
}

TEST(GcodeArc, WhatIsNoArcIsRefused) {
  const std::string start = "G0 X10 Y0 Z5\n";
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-9 F600"),
              HasSubstr("p.gcode:2:1: no arc: its ends differ by 1.0"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 R3 F600"),
              HasSubstr("'R3': no arc of this radius joins points 14.1421 mm"));
  EXPECT_THAT(rejection(start + "G3 X10 Y0 R5 F600"), HasSubstr("no arc of this radius joins points 0 mm"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 F600"), HasSubstr("an arc without a centre"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-10 K1 F600"), HasSubstr("'K1': an arc has R or"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-10 R10 F600"), HasSubstr("an arc has R or"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-10 P0.5 F600"),
              HasSubstr("a whole number of turns from 1 to 100"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-10 W1 F600"), HasSubstr("keeps the tool's orientation"));
  EXPECT_THAT(rejection(start + "G3 X0 Y10 I-10"), HasSubstr("an arc without a feed"));
  EXPECT_THAT(rejection(start + "G1 X0 R10 F600"), HasSubstr("'R10' belongs to no command"));
  EXPECT_EQ(rejection(start + "G3 X0 Y10.01 I-10 F600"), "accepted") << "a file's rounding";
}

// A hundred turns of a circle of 1000 km would be 160 million chords: more than memory holds.
TEST(GcodeArc, EndlessChordsAreRefused) {
  const std::string start = "G0 X10 Y0 Z5\n", circle = "G3 I-10 F600\n";
  EXPECT_THAT(rejection(start + "G3 I1e9 P100 F600"),
              HasSubstr("p.gcode:2:1: an arc of 1.5708e+08 chords, at most 100000"));
  GcodeOptions options;
  options.chords_max = 2 * (steps_of(start + circle).size() - 1);
  EXPECT_EQ(rejection(start + circle + circle, options), "accepted");
  EXPECT_THAT(rejection(start + circle + circle + circle, options),
              HasSubstr("p.gcode:4:1: the program's arcs and splines have more than"));
  const std::string spline = "G5 X20 Y20 I5 J5 P-5 Q-5 F600\n";
  options.chords_max = steps_of(start + spline).size() - 2;
  EXPECT_THAT(rejection(start + spline, options), HasSubstr("p.gcode:2:1: the program's arcs and splines"));
}

}  // namespace
}  // namespace understudy::toolpath

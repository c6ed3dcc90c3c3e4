#include "toolpath/gcode/gcode_passed_over.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

struct Read {
  std::vector<std::string> steps;
  std::vector<PassedOver> lines;
};

std::string described(const Step& step) {
  const char* kind = step.kind == StepKind::travel        ? "travel"
                     : step.kind == StepKind::print       ? "print"
                     : step.kind == StepKind::move        ? "move"
                     : step.kind == StepKind::home        ? "home"
                     : step.kind == StepKind::temperature ? "temperature"
                                                          : "other";
  const Vec3 p = 1e3 * step.X_WT.translation();
  return fmt::format("{}: {} {:.4g},{:.4g},{:.4g} e{:.4g}", step.line, kind, p.x() + 0.0, p.y() + 0.0,
                     p.z() + 0.0, 1e3 * step.filament + 0.0);
}

Read read(const std::string& text) {
  Read read;
  GcodeOptions options;
  options.passed_over = &read.lines;
  for (const Step& step : parse_gcode(text, "p.gcode", options).steps) read.steps.push_back(described(step));
  return read;
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kStart = "M82\nG1 X10 Y0 E1 F600\n";  // its end is 10,0,0 with E1

TEST(LinesPassedOver, NoBeadIsLaidFromAPlaceThatOnlySuchALineSays) {
  const Read bad = read(kStart + "G1 X1.2.3 Y10 E2\nG1 X30 Y20 E3\nG1 X40 Y20 E4\n");
  EXPECT_THAT(bad.steps, ElementsAre("2: print 10,0,0 e1", "4: travel 30,20,0 e0", "5: print 40,20,0 e1"));
  ASSERT_EQ(bad.lines.size(), 1u);
  EXPECT_EQ(bad.lines[0].line, 3);
  EXPECT_EQ(bad.lines[0].last_line, 4);
  EXPECT_EQ(bad.lines[0].why, "'X1.2.3': X needs a finite decimal number");
  EXPECT_EQ(bad.lines[0].unknown, "X");
  EXPECT_NEAR(bad.lines[0].filament, 2e-3, 1e-12);
  EXPECT_TRUE(bad.lines[0].filament_known);
}

// A layer whose height is lost is left out as a whole: at the height of the one below it would plough that.
TEST(LinesPassedOver, MovesAreLeftOutUntilEachLostAxisIsSaidAgain) {
  const Read bad =
      read(kStart + "G1 Z0.4.0\nG1 X30 Y20 E3\nM106 S9\nG1 X40 Y20 E4\nG1 Z0.6\nG1 X50 Y20 E5\n");
  EXPECT_THAT(bad.steps, ElementsAre("2: print 10,0,0 e1", "5: other 10,0,0 e0", "7: travel 40,20,0.6 e0",
                                     "8: print 50,20,0.6 e1"));
  EXPECT_EQ(bad.lines.at(0).last_line, 7);
}

TEST(LinesPassedOver, WhereItsEndCanBeReadTheToolTravelsThere) {
  for (const char* line :
       {"G1 X20 Y10 E2 F0", "G2 X20 Y10 R0.1 E2", "G1 X20 Y10 E2 S7", "G1 X20 Y10 E2 F-"}) {
    const Read bad = read(kStart + line + "\nG1 X30 Y20 E3\n");
    EXPECT_THAT(bad.steps, ElementsAre("2: print 10,0,0 e1", "3: travel 20,10,0 e0", "4: print 30,20,0 e1"))
        << line;
    EXPECT_EQ(bad.lines.at(0).last_line, 3) << line;
    EXPECT_NEAR(bad.lines.at(0).filament, 1e-3, 1e-12) << line;
  }
}

TEST(LinesPassedOver, ALetterTwiceOrTwoLinesInOneSayNoPlace) {
  for (const char* line : {"G1 X15 X16 Y5 E2", "G1 X15 Y5 E2G1 X20 Y8", "G1 X15 E2 @Y5"}) {
    const Read bad = read(kStart + line + "\nG1 X30 Y20 E3\nG1 X40 E4\n");
    EXPECT_THAT(bad.steps, ElementsAre("2: print 10,0,0 e1", "4: travel 30,20,0 e0", "5: print 40,20,0 e1"))
        << line;
  }
}

// Absolute E: the filament of the line is not fed by the next one. Relative E: it is lost with the line.
TEST(LinesPassedOver, ItsFilamentIsFedByNoOtherLine) {
  const std::string rest = "G1 X30 Y20 E3\nG1 X40 Y20 E4\n";
  EXPECT_THAT(read(kStart + "G1 X20 Y10 E2.2.2\n" + rest).steps,
              ElementsAre("2: print 10,0,0 e1", "4: travel 30,20,0 e0", "5: print 40,20,0 e1"))
      << "how much of E3 is the line's own is not known";
  EXPECT_NEAR(read(kStart + "G1 X20 Y10 E2.2.2\n" + rest).lines.at(0).filament, 2e-3, 1e-12);
  const std::string relative = "M83\nG1 X10 Y0 E1 F600\n";
  const Read bad = read(relative + "G1 X20 Y10 E2.2.2\nG1 X30 Y20 E3\n");
  EXPECT_THAT(bad.steps, ElementsAre("2: print 10,0,0 e1", "3: travel 20,10,0 e0", "4: print 30,20,0 e3"));
  EXPECT_FALSE(bad.lines.at(0).filament_known);
  EXPECT_THAT(read(relative + "G1 X20 Y10 E2 F0\nG1 X30 Y20 E3\n").steps,
              ElementsAre("2: print 10,0,0 e1", "3: travel 20,10,0 e0", "4: print 30,20,0 e3"));
}

TEST(LinesPassedOver, WhatIsDrawnBackMeanwhileIsDrawnBack) {
  EXPECT_THAT(read(kStart + "G1 E0.2 F0\nG0 X20\nG1 E1\nG1 X30 E2\n").steps,
              ElementsAre("2: print 10,0,0 e1", "3: move 10,0,0 e-0.8", "4: travel 20,0,0 e0",
                          "5: print 20,0,0 e0.8", "6: print 30,0,0 e1"));
  const Read back = read(kStart + "G1 E0.2\nG0 X20\nG1 E1 F18.0.0\nG1 X30 E2\n");
  EXPECT_THAT(back.steps, ElementsAre("2: print 10,0,0 e1", "3: move 10,0,0 e-0.8", "4: travel 20,0,0 e0",
                                      "5: print 20,0,0 e0.8", "6: print 30,0,0 e1"));
  EXPECT_EQ(back.lines.at(0).filament, 0);
  // One that is lost with a bead behind it: the bead's filament is not fed.
  EXPECT_THAT(read(kStart + "G1 E0.2\nG0 X20\nG1 E1.0.0\nG1 X30 E2\nG1 X40 E3\n").steps,
              ElementsAre("2: print 10,0,0 e1", "3: move 10,0,0 e-0.8", "4: travel 20,0,0 e0",
                          "6: travel 30,0,0 e0", "6: print 30,0,0 e0.8", "7: print 40,0,0 e1"));
}

TEST(LinesPassedOver, FeedAndMotionOfTheLineGoOn) {
  std::vector<PassedOver> lines;
  GcodeOptions options;
  options.passed_over = &lines;
  const Program program = parse_gcode("G0 X1\nG1 X1.2.3 Y2 E1 F1200\nX5 Y5 E2\nX6 E3\n", "p.gcode", options);
  ASSERT_EQ(program.steps.size(), 3u);
  EXPECT_EQ(program.steps[2].kind, StepKind::print);
  EXPECT_NEAR(program.steps[2].feed, 1200 * kMillimetrePerMinute, 1e-12);
}

TEST(LinesPassedOver, TemperaturesFansAndDwellsAreAsIfTheyWereNotThere) {
  const Read bad =
      read("M104 S200\nM109 S2.2.0\nM106 S300\nG4 S-1\nM104\n" + std::string("G1 X10 E1 F600\n"));
  EXPECT_THAT(bad.steps, ElementsAre(StartsWith("1: temperature"), "6: print 10,0,0 e1"));
  EXPECT_EQ(bad.lines.size(), 4u);
}

TEST(LinesPassedOver, HomeSaysWhereTheToolIs) {
  EXPECT_THAT(read(kStart + "G1 X1.2.3\nG28\nG0 X5\n").steps,
              ElementsAre("2: print 10,0,0 e1", "4: travel 0,0,0 e0", "5: travel 5,0,0 e0"));
}

TEST(LinesPassedOver, AnOrientationIsSaidAgainAsAWhole) {
  const Read bad = read("G0 X1 I0 J0 K1\nG0 X2 I0 J0 K0.9\nG0 X3\nG0 X4 I0 J0 K1\nG0 X5\n");
  EXPECT_THAT(bad.steps, ElementsAre("1: travel 1,0,0 e0", "4: travel 4,0,0 e0", "5: travel 5,0,0 e0"));
  EXPECT_EQ(bad.lines.at(0).last_line, 4);
}

TEST(LinesPassedOver, WhatMakesTheRestMeaninglessIsRefused) {
  EXPECT_THAT(refusal(kStart + "G91\nG1 X1.2.3\nG1 X5\n"), StartsWith("p.gcode:4:4: 'X1.2.3'"));
  EXPECT_THAT(refusal(kStart + "G1 X1.2.3\nG91\nG1 Z5\n"),
              HasSubstr("the place of the tool in X is not known here: line 3 cannot be read"));
  EXPECT_THAT(refusal(kStart + "G1 X1.2.3\nG92 X0\n"), HasSubstr("is not known here: line 3"));
  EXPECT_EQ(refusal(kStart + "G1 X1.2.3\nG92 E0\nG1 X5 Y5 E1\n"), "accepted");
  for (const char* line : {"G20 G1 Xa", "G90 X1.2.3", "G28 Q", "G1 X1.2.3 T1", "G1 X5 A7", "G1 X[1+2]", "@",
                           "G1 X1\x01", "o100 sub", "G1 X1.2.3 M30", "G1. X1 X2 G0"})
    EXPECT_THAT(refusal(kStart + line + "\nG1 X5 E2\n"), StartsWith("p.gcode:3")) << line;
  EXPECT_THAT(refusal(kStart + "M30\nG1 X5\n"), HasSubstr("after the end of the program"));
}

TEST(LinesPassedOver, TooManyOfThemAreRefusedWithTheWholeList) {
  std::string text = kStart;
  for (int i = 0; i < kMostPassedOver; ++i) text += "M106 S300\n";
  EXPECT_EQ(read(text).lines.size(), 20u);
  const std::string all = refusal(text + "G1 Xa\n");
  EXPECT_THAT(all,
              StartsWith("p.gcode:3:6: 'S300': the fan's speed is outside 0 to 255; nor can be read line "
                         "4: 'S300'"));
  EXPECT_THAT(all, HasSubstr("; line 23: 'Xa'"));
}

TEST(LinesPassedOver, AProgramOfWhichNothingIsLeftIsRefused) {
  EXPECT_THAT(refusal("G1 X- F600\n"), StartsWith("p.gcode:1:4: 'X-'"));
  EXPECT_THAT(refusal("G0 X1\nG1 Z- F600\nG1 X5 E1\nG1 X6 E2\n"), StartsWith("p.gcode:2:4: 'Z-'"));
}

TEST(LinesPassedOver, OfAProgramThatCanBeReadNothingChanges) {
  const std::string text = kStart + "G91\nG1 X5 E2\nG90\nG92 E0\nG1 E-1\nG28\nM30\n";
  const Read same = read(text);
  EXPECT_THAT(same.lines, IsEmpty());
  std::vector<std::string> plain;
  for (const Step& step : parse_gcode(text, "p.gcode", {}).steps) plain.push_back(described(step));
  EXPECT_EQ(same.steps, plain);
}

TEST(LinesPassedOver, AFaultInAMacroIsRefused) {
  std::vector<PassedOver> lines;
  GcodeOptions options;
  options.passed_over = &lines;
  options.macros =
      std::make_shared<GcodeMacros>(GcodeMacros::parse("[gcode_macro A]\ngcode:\n G1 Xa\n", "m"));
  EXPECT_THROW(parse_gcode("G0 X1\nA\n", "p.gcode", options), InputError);
}

}  // namespace
}  // namespace understudy::toolpath

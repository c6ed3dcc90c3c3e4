#include "toolpath/gcode/words/gcode_words.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<Step> steps_of(const std::string& text, const GcodeOptions& options = {}) {
  return parse_gcode(text, "p.gcode", options).steps;
}

std::string rejection(const std::string& text, const GcodeOptions& options = {}) {
  try {
    steps_of(text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(GcodeWords, LinesOfTextAndOfFirmwaresInWordsAreTold) {
  for (const char* line : {"%", " M117 Printing 100% (of \"it\"", "N5 M118 A1 action:x", "M486 AMy part (1)",
                           "EXCLUDE_OBJECT_START NAME=a", "exclude_object_end name=a",
                           "SET_VELOCITY_LIMIT ACCEL=5", "O1000", "o20 (part)", "SET_GCODE_OFFSET Z=0.0"})
    EXPECT_TRUE(is_line_without_effect(line)) << line;
  for (const char* line : {"", "G1 X1", "M1170", "M117.5", "START_PRINT", "SET_GCODE_OFFSET Z=0.2",
                           "SET_GCODE_OFFSET", "%G1 X1", "M11", "M4865 S1", "O100 sub", "O", "O1 (a) X1"})
    EXPECT_FALSE(is_line_without_effect(line)) << line;
  EXPECT_EQ(command_in_words("  start_print EXTRUDER=220"), "START_PRINT");
  EXPECT_EQ(command_in_words("N12 PRINT_END"), "PRINT_END");
  for (const char* line : {"", "G1X1", "G28 XY", "X1", "T", "; START"})
    EXPECT_EQ(command_in_words(line), "") << line;
}

TEST(GcodeWords, WhatSlicersOfTodayWriteIsRead) {
  EXPECT_EQ(
      steps_of("%\nM115 U3.9\nG29\nG80\nG40 (off)\nM302 S0\nM400\nM117 Hello\nM486 S0\nM75\nG54\nG61\n"
               "EXCLUDE_OBJECT_DEFINE NAME=x POLYGON=[[1,2],[3,4]]\nM106 P2 S255\nM107 P2\nG0 X1\nM2\n%\n")
          .size(),
      2u);
  EXPECT_THAT(rejection("G0 X1\nM2\nG0 X2\n"), HasSubstr("p.gcode:3:1: a move after the end"));
  const auto waited = steps_of("M109 R200\nG0 X1\n");
  EXPECT_NEAR(waited[0].temperature, 200 + kCelsiusZero, 1e-9);
  EXPECT_EQ(steps_of("T1\nT1 M6\nG0 X1\n").size(), 1u);
}

TEST(GcodeWords, CommandsWithoutEffectTakeAnyParametersTextsToo) {
  EXPECT_EQ(steps_of("M115 U3.11.0\nm115 U6.1.0-RC2+1234\nM862.1 P0.4 A0 F0\nM862.3 P \"MK4IS\"\nM593 T2\n"
                     "M0 Insert the nut M3\nM5 G0 X1\n")
                .size(),
            1u);
  EXPECT_THAT(rejection("M115 U3.9 G1 X5\nG0 X1\n"), HasSubstr("'G1' is no parameter of 'M115'"));
  EXPECT_THAT(rejection("G61 U3\nG0 X1\n"), HasSubstr("'U3' is no parameter of 'G61'"));
}

TEST(GcodeWords, FootersMayFollowTheEnd) {
  EXPECT_EQ(steps_of("G0 X1\nM30\nM82\nM104 S0\nG92 E0\nM84\n").size(), 2u);
  EXPECT_THAT(rejection("G0 X1\nM2\nG28\n"), HasSubstr("a move after the end"));
}

TEST(GcodeWords, ACarriageThatTheMachineLacksIsHomedInVain) {
  EXPECT_EQ(steps_of("G28 X0 U0\nG28 U\nG0 X1\n").size(), 2u) << "G28 U is no G28 of all axes";
  EXPECT_THAT(rejection("G0 X1 U5\n"), HasSubstr("unknown word 'U5'"));
}

TEST(GcodeWords, ATurningAxisThatTheMachineLacksStandsAtZero) {
  EXPECT_EQ(steps_of("G90 G01 X0 Y0 Z5 A0 B0.0 C0 F1000\n").size(), 1u);
  EXPECT_THAT(rejection("G1 X1 A0 B3 F60\n"), HasSubstr("'B3': this machine has no rotary axes"));
}

TEST(GcodeWords, AControllersOwnCommandIsAWord) {
  EXPECT_EQ(command_in_words("#TRAFO ON"), "#TRAFO");
  EXPECT_EQ(command_in_words("#100=3"), "");
  EXPECT_THAT(rejection("#TRAFO ON\nG0 X1\n"), HasSubstr("unknown word '#TRAFO'"));
  GcodeOptions options;
  options.ignored = {"#TRAFO"};
  EXPECT_EQ(steps_of("#TRAFO ON\nG0 X1\n#TRAFO OFF\n", options).size(), 1u);
}

TEST(GcodeWords, AnIgnoredStartMacroHeatsANozzleThatIsStillCold) {
  GcodeOptions options;
  options.ignored = {"START_PRINT", "END_PRINT", "M428"};
  options.ignored_heat = 483.15;
  const auto steps =
      steps_of("M104 S0\nM428\nSTART_PRINT T=210\nM83\nG1 X1 E1 F60\nM104 S0\nEND_PRINT\n", options);
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[1].line, 3);
  EXPECT_EQ(steps[1].temperature, 483.15);
  EXPECT_TRUE(steps[1].wait);
  EXPECT_EQ(steps_of("M109 S230\nSTART_PRINT\nG0 X1\n", options).size(), 2u) << "it is hot already";
}

TEST(GcodeWords, AllUnknownWordsAreToldAtOnceWithTheirCounts) {
  const std::string message =
      rejection("G0 X1\nM428\nSTART_PRINT BED=60\nM428\nG1 X2 F600\nG92.1\nM700 S1\n");
  EXPECT_THAT(message,
              HasSubstr("p.gcode:2:1: unknown words 'M428' (2 lines from line 2), 'START_PRINT' (1 line "
                        "from line 3), 'G92.1' (1 line from line 6), 'M700' (1 line from line 7)"));
  EXPECT_THAT(message, HasSubstr("--ignore"));
  // What is wrong only because a line was not read is not told.
  EXPECT_THAT(rejection("G0 X1\nSETUP F600\nG1 X2\n"), HasSubstr("unknown word 'SETUP'"));
  EXPECT_THAT(rejection("G0 X1\nSETUP F600\nG1 X2\n"), Not(HasSubstr("feed")));
}

TEST(GcodeWords, WhatIsIgnoredIsPassedOverWithItsLine) {
  GcodeOptions options;
  options.ignored = {"M428", "START_PRINT", "G5"};
  EXPECT_EQ(steps_of("m428\nStart_Print BED=60 \"x\nG5 X7 P1 Q#\nG0 X1\n", options).size(), 1u);
  EXPECT_THAT(rejection("G50\nG0 X1\n", options), HasSubstr("unknown word 'G50'")) << "G5 is another word";
}

TEST(GcodeWords, TheSpeedIsInPercentOfTheFeed) {
  const auto steps = steps_of("G0 X0 Y0 Z0\nM220 S50\nG1 X10 F600\nM220 S200\nG93 G1 X20 F2\n");
  EXPECT_NEAR(steps[1].feed, 0.005, 1e-12);
  EXPECT_NEAR(steps[2].duration, 15, 1e-9);
  EXPECT_THAT(rejection("M220 S0\nG0 X1"), HasSubstr("'S0': the speed is outside 1 to 1000 %"));
  EXPECT_NEAR(steps_of("M220 S50\nM220\nG1 X1 F120\n")[0].feed, 1e-3, 1e-15) << "a question";
}

TEST(GcodeWords, AFirmwaresRetractionDrawsBackAndPushesTheSame) {
  const auto steps = steps_of("M207 S0.8 F2400 Z0.2\nG0 X1 F600\nG10\nG10\nG0 X2\nG11\nG11\nG0 X3\n");
  ASSERT_EQ(steps.size(), 5u);
  EXPECT_NEAR(to_mm(steps[1].filament), -0.8, 1e-12);
  EXPECT_NEAR(steps[1].duration, 0.02, 1e-12);
  EXPECT_NEAR(to_mm(steps[3].filament), 0.8, 1e-12);
  EXPECT_THAT(rejection("G0 X1\nG10\n"), HasSubstr("add M207 with S (mm) and F (mm/min)"));
  EXPECT_THAT(rejection("M207 S1 F60\nG0 X1\nG10 L2 P1\n"), HasSubstr("p.gcode:3"));
  EXPECT_THAT(rejection("M207 S-1 F60\nG0 X1\n"), HasSubstr("outside 0 to 1000 mm"));
  EXPECT_THAT(rejection("M207 S1\nG0 X1\n"), HasSubstr("needs S, the length in mm, and F"));
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/gcode/gcode_refused.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  std::vector<PassedOver> passed_over;
  GcodeOptions options;
  options.passed_over = &passed_over;
  try {
    parse_gcode(text, "p.gcode", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

struct Read {
  RefusedLines refused;
  Program program;
};

/// As `inspect` reads: without the lines that are refused.
Read read_rest(const std::string& text) {
  Read read;
  std::vector<PassedOver> passed_over;
  GcodeOptions options;
  options.passed_over = &passed_over;
  options.refused = &read.refused;
  read.program = parse_gcode(text, "p.gcode", options);
  return read;
}

constexpr const char* kThree = "G29 Q1 \"x\nM428 P1\nG1 X1 F60\nG92\nT3\n";

TEST(GcodeRefused, AllThatIsWrongIsToldAtOnce) {
  const std::string all = refusal(kThree);
  EXPECT_THAT(all, StartsWith("p.gcode:2:1: unknown word 'M428'"));
  for (const char* part :
       {"line 1: '\"' starts no word", "line 4: G92 names none of X Y Z E",
        "line 5: 'T3': the machine has one extruder", "`--ignore G29` passes over such lines"})
    EXPECT_THAT(all, HasSubstr(part));
}

TEST(GcodeRefused, OneAloneIsToldAsItIs) {
  EXPECT_EQ(refusal("G1 X1 F60\nT3\n"), "p.gcode:2:1: 'T3': the machine has one extruder, T0 or T1");
}

TEST(GcodeRefused, ARefusedLineLeavesNothingBehind) {
  const auto [refused, program] = read_rest("G91 G1 X5 F600 T3\nG1 X2 F60\n");
  ASSERT_EQ(refused.lines, 1);
  EXPECT_EQ(refused.told[0].line, 1);
  EXPECT_EQ(refused.told[0].command, "G91");
  ASSERT_EQ(program.steps.size(), 1u);
  EXPECT_NEAR(program.steps[0].X_WT.translation().x(), 2e-3, 1e-12);
}

TEST(GcodeRefused, ManyAreCountedAndTheFirstTold) {
  std::string text = "G1 X1 F60\n";
  for (int i = 0; i < 50; ++i) text += "T3\n";
  const RefusedLines refused = read_rest(text).refused;
  EXPECT_EQ(refused.lines, 50);
  EXPECT_EQ(refused.told.size(), static_cast<std::size_t>(kMostRefused));
}

TEST(GcodeRefused, WhatHasAnEffectIsNotIgnored) {
  for (const char* command : {"M428", "START_PRINT", "#TRAFO", "M115", "G29"})
    EXPECT_TRUE(can_be_ignored(command)) << command;
  for (const char* command : {"G1", "G92", "M83", "M104", "T3", "X", ""})
    EXPECT_FALSE(can_be_ignored(command)) << command;
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/gcode/gcode_extrusion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

ExtrusionTally tally_of(const std::string& text, bool relative = false) {
  GcodeOptions options;
  ExtrusionTally tally;
  options.extrusion = &tally;
  options.relative_extrusion = relative;
  parse_gcode(text, "p.gcode", options);
  return tally;
}

std::string relative_program(const std::string& before) {
  std::string text = before + "G1 Z0.2 F600\n";
  for (int i = 0; i < 40; ++i) {
    text += fmt::format("G1 X{} Y{} E{:.4f}\n", i % 7, i % 5, 0.01 + 0.001 * (i * 7 % 11));
    if (i % 10 == 9) text += "G1 E-2\nG0 X0\nG1 E2\n";
  }
  return text;
}

TEST(GcodeExtrusion, ShortWordsThatRiseAndFallLookRelative) {
  const ExtrusionTally tally = tally_of(relative_program("G21\n"));
  EXPECT_TRUE(tally.looks_relative());
  EXPECT_EQ(tally.moves, 40);
  EXPECT_EQ(tally.first_line, 3);
  EXPECT_NEAR(tally.by_words, 40 * 0.015e-3, 2e-5);
}

TEST(GcodeExtrusion, WordsThatAreReadAsRelativeAreNotCounted) {
  EXPECT_EQ(tally_of(relative_program("M83\n")).moves, 0);
  EXPECT_EQ(tally_of(relative_program("G21\n"), true).moves, 0);
  EXPECT_EQ(tally_of(relative_program("M82\n"), true).moves, 40) << "the program's own word counts";
}

TEST(GcodeExtrusion, LinesOfOneLengthLookRelativeToo) {
  std::string text = "G1 Z0.2 F600\n";
  for (int i = 0; i < 10; ++i) text += fmt::format("G1 X{} E0.4\n", 10 * (i % 2));
  EXPECT_TRUE(tally_of(text).looks_relative());
}

// Every third move wipes: draws filament back on the way, and the next pushes it back at rest.
TEST(GcodeExtrusion, AbsoluteWordsWithRetractionsWipesAndResetsDoNot) {
  std::string text = "G1 Z0.2 F600\n";
  double e = 0;
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("G1 X{} E{:.4f}\n", i % 7, e += 0.03);
    text += fmt::format("G1 Y{} E{:.4f}\n", i % 5, e += 0.02);
    text += fmt::format("G1 X{} E{:.4f}\nG0 X3\nG1 E{:.4f}\n", i % 3, e - 0.8, e);
    if (i % 20 == 19) text += "G92 E0\n", e = 0;
  }
  const ExtrusionTally tally = tally_of(text);
  EXPECT_EQ(tally.moves, 180);
  EXPECT_FALSE(tally.looks_relative());
}

TEST(GcodeExtrusion, ADryRunFeedsNothingEitherWay) {
  std::string text = "G1 Z0.2 F600\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("G1 X{} E0\n", i % 7);
  EXPECT_FALSE(tally_of(text).looks_relative());
}

}  // namespace
}  // namespace understudy::toolpath

#include "toolpath/pass_over.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

std::vector<std::string> words(const Program& program) {
  std::vector<std::string> all;
  for (const Step& step : program.steps) {
    const char* kind = step.kind == StepKind::travel  ? "travel"
                       : step.kind == StepKind::print ? "print"
                       : step.kind == StepKind::fan   ? "fan"
                       : step.kind == StepKind::home  ? "home"
                                                      : "other";
    all.push_back(kind + std::string(" to ") +
                  std::to_string(std::lround(1e3 * step.X_WT.translation().x())) + " of line " +
                  std::to_string(step.line));
  }
  return all;
}

std::vector<std::string> without(const std::string& text, const std::vector<std::size_t>& steps) {
  Program program = parse_gcode(text, "p.gcode", {});
  pass_over(program, Pose::Identity(), steps);
  return words(program);
}

const std::string kStrokes = "M83\nG0 X1\nG1 X2 E1 F600\nG1 X900 E1\nM106 S255\nG1 X3 E1\nG1 X4 E1\n";

TEST(PassOver, TheNextBeadBeginsWhereItWasToBegin) {
  EXPECT_EQ(without(kStrokes, {2, 4}),
            (std::vector<std::string>{"travel to 1 of line 2", "print to 2 of line 3", "fan to 2 of line 5",
                                      "travel to 3 of line 7", "print to 4 of line 7"}));
}

TEST(PassOver, ATravelOrHomeNeedsNoOtherBeforeIt) {
  EXPECT_EQ(without("G0 X1\nG0 X900\nG0 X2\n", {1}),
            (std::vector<std::string>{"travel to 1 of line 1", "travel to 2 of line 3"}));
  EXPECT_EQ(without("G0 X1\nG0 X900\nG28\n", {1}),
            (std::vector<std::string>{"travel to 1 of line 1", "home to 0 of line 3"}));
}

// The stroke drawn back before 900 is drawn back where the next one begins, and the bead there is its own.
TEST(PassOver, WhatWasDrawnBackMeanwhileIsDrawnBackAndNoMoreIsFed) {
  Program program =
      parse_gcode("M83\nG0 X1\nG1 X2 E1 F600\nG1 X900 E2\nG1 E-.8\nG0 X3\nG1 E.8\nG1 X4 E1\n", "p.gcode", {});
  pass_over(program, Pose::Identity(), {2});
  EXPECT_EQ(words(program), (std::vector<std::string>{"travel to 1 of line 2", "print to 2 of line 3",
                                                      "other to 2 of line 6", "travel to 3 of line 6",
                                                      "print to 3 of line 7", "print to 4 of line 8"}));
  ASSERT_EQ(program.steps.size(), 6u);
  EXPECT_NEAR(program.steps[2].filament, -0.8e-3, 1e-12);
  EXPECT_NEAR(program.steps[4].filament, 0.8e-3, 1e-12);
  Program rejoined =
      parse_gcode("M83\nG0 X1\nG1 X2 E1 F600\nG1 X900 E2\nG1 E-.8\nG1 X3 E1\nG1 X4 E1\n", "p.gcode", {});
  pass_over(rejoined, Pose::Identity(), {2, 4});
  EXPECT_EQ(words(rejoined), (std::vector<std::string>{"travel to 1 of line 2", "print to 2 of line 3",
                                                       "travel to 3 of line 7", "print to 4 of line 7"}))
      << "drawn back, and pushed back by the bead that is left out";
}

TEST(PassOver, NothingAndTheEndAreLeftOutAsWell) {
  EXPECT_EQ(without(kStrokes, {}).size(), 6u);
  EXPECT_EQ(without("G0 X1\nG0 X900\n", {1}), (std::vector<std::string>{"travel to 1 of line 1"}));
}

}  // namespace
}  // namespace understudy::toolpath

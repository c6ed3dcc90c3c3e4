#include "rehearsal/program/told_filament.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

toolpath::ExtrusionTally relative_tally() { return {100, 3, 48, 92, 0.225}; }

TEST(ToldFilament, RelativeWordsReadAsAbsoluteAreAnError) {
  const auto finding = misread_extrusion(relative_tally(), 0.0002, 0.22503);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->severity, Severity::error);
  EXPECT_EQ(finding->gcode_line, 92);
  EXPECT_THAT(
      finding->message,
      HasSubstr("E looks relative: it does not rise at 48 of 100 moves from line 92 on; read as absolute it "
                "feeds 0.2 mm of filament, read as relative 225.0 mm; the slicer's comment says 225.0 mm"));
  EXPECT_THAT(misread_extrusion(relative_tally(), 0.0002, {})->message, Not(HasSubstr("comment")));
}

TEST(ToldFilament, NextToNothingOfTheCommentsFilamentIsAnError) {
  ASSERT_TRUE(other_amount(0.02, 0.2));
  EXPECT_EQ(other_amount(0.02, 0.2)->severity, Severity::error);
  EXPECT_EQ(other_amount(0.1, 0.2)->severity, Severity::warning);
  EXPECT_FALSE(other_amount(0, {}));
  EXPECT_FALSE(misread_extrusion({}, 0.02, 0.2)) << "no word of E looks relative";
}

TEST(ToldFilament, AnotherAmountThanTheCommentsIsAWarning) {
  ASSERT_TRUE(other_amount(1.0, 2.0));
  EXPECT_EQ(other_amount(1.0, 2.0)->severity, Severity::warning);
  EXPECT_TRUE(other_amount(2.6, 2.0));
  EXPECT_FALSE(other_amount(2.1, 2.0));
  EXPECT_FALSE(other_amount(0.25, 0.2)) << "start lines purge as much";
  EXPECT_FALSE(other_amount(0.25, {}));
}

TEST(ToldFilament, WhatARetractionTookBackCountsOnce) {
  toolpath::Program program;
  for (const double filament : {0.01, -0.005, 0.005, 0.02, -0.03}) {
    program.steps.emplace_back();
    program.steps.back().filament = filament;
  }
  EXPECT_NEAR(fresh_filament(program), 0.03, 1e-12);
}

}  // namespace
}  // namespace understudy::rehearsal

#include "rehearsal/findings/flow_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

FlowStretch stretch(int line, double length, double ratio) {
  return {line, 0.1 * line, Vec3::Zero(), length, ratio, (ratio - 1) * length};
}

TEST(FlowFindings, AFewAreToldOneByOne) {
  const auto findings = flow_findings({stretch(3, 1e-3, 0.2), stretch(9, 8e-3, 1.4)});
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].about, "too little");
  EXPECT_EQ(findings[1].about, "too much");
  EXPECT_EQ(findings[1].gcode_line, 9);
}

TEST(FlowFindings, ManyStartsAndEndsAreOne) {
  std::vector<FlowStretch> stretches;
  for (int line = 1; line <= 500; ++line) stretches.push_back(stretch(line, 1e-3, line == 77 ? 0.1 : 0.5));
  stretches.push_back(stretch(600, 30e-3, 0.7));
  const auto findings = flow_findings(stretches);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].gcode_line, 600) << "a long stretch stands for itself";
  EXPECT_EQ(findings[1].gcode_line, 1);
  EXPECT_EQ(findings[1].last_line, 500);
  EXPECT_EQ(findings[1].severity, Severity::warning);
  EXPECT_THAT(findings[1].message, testing::HasSubstr("at 500 starts, ends and corners"));
  EXPECT_THAT(findings[1].message, testing::HasSubstr("over 500 mm in all"));
  EXPECT_THAT(findings[1].message, testing::HasSubstr("on line 77"));
}

FillFigures filled(double fed, double laid) { return {fed, laid, 1, 12, 0, Vec3::Zero()}; }

TEST(FillFindings, VoidsAreAnErrorAndTooMuchIsAWarning) {
  EXPECT_TRUE(fill_findings(std::nullopt).empty());
  EXPECT_TRUE(fill_findings(filled(0.97, 0.95)).empty());
  const auto voids = fill_findings(filled(0.6, 0.59));
  ASSERT_EQ(voids.size(), 1u);
  EXPECT_EQ(voids[0].severity, Severity::error);
  EXPECT_EQ(voids[0].about, kVoids);
  EXPECT_EQ(voids[0].gcode_line, 12);
  EXPECT_THAT(voids[0].message, testing::HasSubstr("60 % of the space between them, less than 85 %"));
  const auto full = fill_findings(filled(1.3, 1.28));
  ASSERT_EQ(full.size(), 1u);
  EXPECT_EQ(full[0].severity, Severity::warning);
}

// OrcaSlicer's default speeds: 0.926 is fed, 0.75 lies along half of the lines.
TEST(FillFindings, LagIsNoShortage) {
  const auto lag = fill_findings(filled(0.926, 0.75));
  ASSERT_EQ(lag.size(), 1u);
  EXPECT_EQ(lag[0].about, kLag);
  EXPECT_EQ(lag[0].severity, Severity::warning);
  EXPECT_THAT(lag[0].message, testing::HasSubstr("no more than 75 % lies there"));
}

TEST(FillFindings, LagThatLeavesRealGapsIsAnError) {
  EXPECT_EQ(fill_findings(filled(0.95, 0.45)).at(0).severity, Severity::error);
}

// A third more is fed than there is room for; the lag hides it from the beads of most lines.
TEST(FillFindings, TooMuchIsFoundInSpiteOfTheLag) {
  const auto findings = fill_findings(filled(1.24, 1.0));
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].about, kOverfilled);
  EXPECT_EQ(findings[1].about, kLag);
}

}  // namespace
}  // namespace understudy::rehearsal

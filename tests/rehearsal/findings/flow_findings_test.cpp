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

TEST(FillFinding, VoidsAreAnErrorAndTooMuchIsAWarning) {
  EXPECT_FALSE(fill_finding(std::nullopt));
  EXPECT_FALSE(fill_finding(FillFigures{0.97, 1, 1, 0, Vec3::Zero()}));
  const auto voids = fill_finding(FillFigures{0.6, 1, 12, 0, Vec3::Zero()});
  ASSERT_TRUE(voids);
  EXPECT_EQ(voids->severity, Severity::error);
  EXPECT_EQ(voids->gcode_line, 12);
  EXPECT_THAT(voids->message, testing::HasSubstr("fills 60 % of the space between them, less than 85 %"));
  const auto full = fill_finding(FillFigures{1.3, 1, 12, 0, Vec3::Zero()});
  ASSERT_TRUE(full);
  EXPECT_EQ(full->severity, Severity::warning);
}

}  // namespace
}  // namespace understudy::rehearsal

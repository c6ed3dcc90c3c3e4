#include "rehearsal/findings/accuracy_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

const machine::AcceptedErrors kAccepted{from_mm(0.5), from_deg(2)};

TEST(AccuracyFindings, APrintWithinTheAcceptedErrorsHasNone) {
  EXPECT_TRUE(accuracy_findings({from_mm(0.5), 7, 1}, {from_deg(2), 9, 2}, kAccepted).empty());
}

// A square 1.7 mm out of place, to the last bead's own line.
TEST(AccuracyFindings, ATipBeyondNamesValueLimitAndLine) {
  const auto findings = accuracy_findings({from_mm(1.7), 12, 3.5}, {}, kAccepted);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_EQ(findings[0].about, kTip);
  EXPECT_EQ(findings[0].gcode_line, 12);
  EXPECT_NEAR(findings[0].value, 1.7, 1e-12);
  EXPECT_NEAR(findings[0].limit, 0.5, 1e-12);
  EXPECT_THAT(findings[0].message,
              testing::HasSubstr("1.700 mm from what the program asks for, more than 0.5 mm"));
}

TEST(AccuracyFindings, AToolThatLeansIsAFindingOfItsOwnInDegrees) {
  const auto findings = accuracy_findings({from_mm(1), 3, 1}, {from_deg(2.5), 12, 3.5}, kAccepted);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[1].about, kOrientation);
  EXPECT_EQ(findings[1].unit, "deg");
  EXPECT_NEAR(findings[1].value, 2.5, 1e-9);
}

}  // namespace
}  // namespace understudy::rehearsal

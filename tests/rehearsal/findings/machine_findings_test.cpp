#include "rehearsal/findings/machine_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(MachineFindings, AMeasuredMachineHasNone) { EXPECT_THAT(machine_findings({}), IsEmpty()); }

TEST(MachineFindings, WhatIsAssumedIsAWarningThatSaysWhatDependsOnIt) {
  const auto findings = machine_findings({{"play", "masses"}, {}, {}});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, "assumption");
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[0].value, 2);
  EXPECT_THAT(findings[0].message, HasSubstr("masses (loads of the drives"));
  EXPECT_THAT(findings[0].message, HasSubstr("play (errors of the tip"));
  EXPECT_THAT(findings[0].message, Not(HasSubstr("optics")));
}

TEST(MachineFindings, LinksWithoutShapesAreNamed) {
  const auto findings = machine_findings({{}, {"forearm", "wrist 1"}, {}});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, "unchecked");
  EXPECT_THAT(findings[0].message, HasSubstr("forearm, wrist 1"));
}

}  // namespace
}  // namespace understudy::rehearsal

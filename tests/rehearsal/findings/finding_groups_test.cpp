#include "rehearsal/findings/finding_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;

Finding finding(const char* kind, int line, double value, double limit, const char* about = "") {
  return {kind, Severity::error, line, 0.1 * line, value, limit, "mm", "", 0, about};
}

std::vector<std::string> kinds(const Record& record) {
  std::vector<std::string> names;
  for (const FindingGroup& group : group_findings(record)) names.push_back(group.worst.kind);
  return names;
}

TEST(FindingGroups, AlikeFindingsAreOneWithCountExtentAndWorst) {
  Record record;
  record.findings = {finding("adhesion", 12, 0.21, 0.2, kTooHigh),
                     finding("adhesion", 14, 0.35, 0.2, kTooHigh),
                     finding("adhesion", 90, 0.25, 0.2, kTooHigh), finding("adhesion", 20, 80, 105, kCold)};
  record.findings[2].last_line = 93;
  const auto groups = group_findings(record);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].count, 3);
  EXPECT_EQ(groups[0].first_line, 12);
  EXPECT_EQ(groups[0].last_line, 93);
  EXPECT_EQ(groups[0].worst.gcode_line, 14);
  EXPECT_EQ(extent_of(groups[0]), "lines 12 to 93, 3 times");
  EXPECT_EQ(extent_of(groups[1]), "line 20");
}

// A clearance is worse the smaller it is, a strand the more it sags.
TEST(FindingGroups, TheWorstIsFarthestBeyondItsLimitEitherWay) {
  Record record;
  record.findings = {finding("collision", 5, -0.02, 0), finding("collision", 8, -0.7, 0),
                     finding("collision", 9, -0.1, 0)};
  EXPECT_EQ(group_findings(record).front().worst.gcode_line, 8);
}

// A nozzle that ploughs is why the beads behind it do not stick, though these come first in the program.
TEST(FindingGroups, CausesStandAheadOfWhatComesOfThem) {
  Record record;
  record.findings = {finding("sag", 3, 1, 0.2),
                     finding("adhesion", 4, 0, 0, kTooLow),
                     finding("gap", 5, 0.05, 0.1, kTooLow),
                     finding("collision", 30, -0.3, 0, "nozzle and part"),
                     finding("joint_limit", 80, 230, 200, "axis z"),
                     finding("program", 90, 0.4, 0, "line that is passed over, 90")};
  EXPECT_THAT(kinds(record), ElementsAre("program", "joint_limit", "collision", "gap", "adhesion", "sag"));
}

TEST(FindingGroups, WarningsFollowEveryError) {
  Record record;
  record.findings = {finding("joint_limit", 1, 1, 2), finding("sag", 3, 1, 0.2)};
  record.findings[0].severity = Severity::warning;
  EXPECT_THAT(kinds(record), ElementsAre("sag", "joint_limit"));
}

// 1.7 mm beside the place, the tip may well be 0.3 mm deep in the part; 0.1 mm of error is no reason for
// that.
TEST(FindingGroups, ATipErrorComesBeforeTheContactsThatItExplains) {
  Record record;
  record.findings = {finding("collision", 3, -0.3, 0), finding("accuracy", 7, 1.7, 0.5, kTip)};
  record.accuracy.emplace().tip_max_um = 1700;
  EXPECT_THAT(kinds(record), ElementsAre("accuracy", "collision"));
  record.accuracy->tip_max_um = 100;
  EXPECT_THAT(kinds(record), ElementsAre("collision", "accuracy"));
}

TEST(FindingGroups, AFindingWithoutALineHasNoExtent) {
  Record record;
  record.findings = {finding("gap", 0, 0.13, 0.2, kUncontrolled)};
  EXPECT_EQ(extent_of(group_findings(record).front()), "");
}

}  // namespace
}  // namespace understudy::rehearsal

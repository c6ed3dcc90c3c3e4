#include "rehearsal/findings/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

Record stopped_by_constraints() {
  Record record;
  record.findings = {{"strut_length", Severity::error, 1187, 41.2, 241.7, 240.0, "mm",
                      "strut 3 is 241.7 mm, longer than 240.0 mm"},
                     {"joint_angle", Severity::error, 1192, 41.9, 63.1, 60.0, "deg",
                      "ball joint 2 is at 63.1 deg, above 60.0 deg"}};
  return record;
}

Record printed(bool go) {
  Record record;
  record.go = go;
  record.print.emplace();
  record.gap.emplace().start_mm = 0.131;
  return record;
}

TEST(VerdictSentence, NamesTheCauseAndCountsTheRest) {
  EXPECT_EQ(
      verdict_sentence(stopped_by_constraints()),
      "Strut 3 is 241.7 mm, longer than 240.0 mm (line 1187), and 1 other error; the program was not run.");
  Record loose = printed(false);
  loose.findings = {{"adhesion", Severity::error, 14, 6.0, 0.4123, 0.2, "mm",
                     "the bead is laid at a gap of 0.412 mm, above 0.200 mm: it does not stick"}};
  EXPECT_EQ(verdict_sentence(loose),
            "The bead is laid at a gap of 0.412 mm, above 0.200 mm: it does not stick (line 14).");
}

TEST(VerdictSentence, SaysWhichLinesTheFiguresAreWithout) {
  Record record = printed(false);
  record.findings = {
      {"program", Severity::error, 12, 0, 0.4, 0, "mm", "line 12 cannot be read; passed over"}};
  record.passed_over = {{12, 12}};
  EXPECT_EQ(verdict_sentence(record),
            "Line 12 cannot be read; passed over (line 12). All figures are of the program without line 12.");
  record.passed_over = {{12, 12}, {40, 44}};
  EXPECT_THAT(verdict_sentence(record), testing::EndsWith("of the program without lines 12 and 40 to 44."));
}

// 537 rows below their limit, though only warnings, are not "no limit is broken".
TEST(VerdictSentence, DoesNotSayThatNoLimitIsBrokenBesideWarnings) {
  Record record = printed(true);
  EXPECT_THAT(verdict_sentence(record), testing::StartsWith("No limit is broken: the gap starts"));
  for (int i = 0; i < 537; ++i)
    record.findings.push_back({"flow", Severity::warning, i, 1, 0.5, 0.8, "1", "too little is laid"});
  EXPECT_THAT(
      verdict_sentence(record),
      testing::StartsWith("Nothing stands against the print, with 537 warnings of flow: the gap starts"));
}

TEST(Grade, IsOfThreeAndAGoWithWarningsIsAGo) {
  Record record = printed(true);
  EXPECT_STREQ(word(grade_of(record)), "go");
  record.findings = {{"flow", Severity::warning, 1, 1, 0.5, 0.8, "1", "too little is laid"}};
  EXPECT_STREQ(word(grade_of(record)), "go-with-warnings");
  EXPECT_STREQ(headline(grade_of(record)), "GO with warnings");
  EXPECT_TRUE(record.go);
  EXPECT_STREQ(headline(grade_of(stopped_by_constraints())), "NO-GO");
}

TEST(VerdictSentence, AWarningIsNeverTheReasonOfANoGo) {
  Record record = stopped_by_constraints();
  record.findings.insert(record.findings.begin(),
                         {"near_collision", Severity::warning, 3, 1, 1, 2, "mm", "close"});
  EXPECT_EQ(verdict_sentence(record).rfind("Strut 3", 0), 0u);
}

// 0.9999 of the path is not all of it.
TEST(VerdictSentence, RoundsTheInBandFractionDown) {
  Record record = printed(true);
  record.gap->in_band_fraction = 0.9999;
  EXPECT_NE(verdict_sentence(record).find("99.9 %"), std::string::npos);
  record.gap->in_band_fraction = 1;
  EXPECT_NE(verdict_sentence(record).find("100.0 %"), std::string::npos);
}

}  // namespace
}  // namespace understudy::rehearsal

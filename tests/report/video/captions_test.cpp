#include "report/video/captions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::report {
namespace {

using testing::ElementsAre;
using testing::Field;

rehearsal::FindingGroup found(const std::string& message, double time, rehearsal::Severity severity) {
  rehearsal::FindingGroup group;
  group.worst.kind = "gap";
  group.worst.message = message;
  group.worst.gcode_line = 7;
  group.worst.time_s = time;
  group.worst.severity = severity;
  return group;
}

TEST(VideoCaptions, AFindingIsShownFromItsInstantOn) {
  const std::vector findings{found("too wide", 4, rehearsal::Severity::error)};
  EXPECT_TRUE(captions_at(findings, 3.9, 2).empty());
  const auto shown = captions_at(findings, 4, 2);
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0].text, "line 7: gap: too wide");
  EXPECT_TRUE(shown[0].error);
  EXPECT_TRUE(captions_at(findings, 6.1, 2).empty());
}

TEST(VideoCaptions, TheLatestTwoAreShown) {
  const std::vector findings{found("a", 1, rehearsal::Severity::error),
                             found("b", 3, rehearsal::Severity::warning),
                             found("c", 2, rehearsal::Severity::error)};
  EXPECT_THAT(captions_at(findings, 3, 5),
              ElementsAre(Field(&Caption::text, "line 7: gap: b"), Field(&Caption::text, "line 7: gap: c")));
}

TEST(VideoCaptions, SignsThatTheFontHasNotAreSpelled) {
  EXPECT_EQ(in_ascii("12 µm at 3° – 2×4 \n é"), "12 um at 3 deg - 2x4 ? ?");
}

}  // namespace
}  // namespace understudy::report

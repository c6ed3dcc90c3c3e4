#include "rehearsal/findings/start_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

int end_of(std::string_view text) { return start_block_end(text, toolpath::FeatureTypes(text)); }

Finding error_on(int line, const char* kind, double value = 1, const char* about = "") {
  return {kind, Severity::error, line, 0, value, 0, "mm", "as found", 0, about};
}

TEST(StartBlock, EndsWhereTheFirstLayerBegins) {
  EXPECT_EQ(end_of("G28\nG1 Z15\n;LAYER:-2\n;TYPE:RAFT\n"), 3);
  EXPECT_EQ(end_of("G28\n;LAYER_CHANGE\n;Z:0.2\n"), 2);
  EXPECT_EQ(end_of("G28\n; CHANGE_LAYER\n"), 2);
  EXPECT_EQ(end_of("G28\nG1 X9\n; layer 1, Z = 0.2\n"), 3);
}

TEST(StartBlock, EndsWithTheFirstFeatureOfThePart) {
  EXPECT_EQ(end_of(";TYPE:Custom\nG28\n;TYPE:Perimeter\nG1 X9\n"), 3);
}

TEST(StartBlock, SettingsAndLaterLayersAreNoBeginning) {
  EXPECT_EQ(end_of(";Layer height: 0.2\n;LAYER_COUNT:50\nG1 X9 E1\n; layer 2\n"), 0);
}

TEST(StartBlock, APrimeLineInTheAirIsAWarning) {
  std::vector<Finding> findings{error_on(5, "adhesion"), error_on(6, "sag"), error_on(12, "adhesion"),
                                error_on(5, "gap")};
  tell_start_block(10, findings);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_THAT(findings[0].message, testing::HasSubstr("(before the first layer)"));
  EXPECT_EQ(findings[1].severity, Severity::warning);
  EXPECT_EQ(findings[2].severity, Severity::error) << "on the part";
  EXPECT_EQ(findings[3].severity, Severity::error) << "a nozzle in the table is one anywhere";
}

TEST(StartBlock, ANozzleThatIsSentToTheTableTouchesIt) {
  std::vector<Finding> findings{error_on(5, "collision", -0.004, "nozzle and table"),
                                error_on(5, "collision", -0.4, "nozzle and table"),
                                error_on(12, "collision", -0.004, "nozzle and table")};
  tell_start_block(10, findings);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[1].severity, Severity::error);
  EXPECT_EQ(findings[2].severity, Severity::error);
}

TEST(StartBlock, ANozzleThatPloughsThroughThePurgeLineSpoilsNoPart) {
  std::vector<Finding> findings{error_on(412, "collision", -0.186, "nozzle and bead"),
                                error_on(412, "collision", -0.186, "nozzle and bead"),
                                error_on(412, "collision", -0.186, "heater block and bead")};
  for (const std::size_t i : {0u, 2u}) findings[i].bead_line = 5;
  findings[1].bead_line = 300;
  tell_start_block(10, findings);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[1].severity, Severity::error);
  EXPECT_EQ(findings[2].severity, Severity::error);
}

TEST(StartBlock, CountsLinesAsTheReaderDoes) {
  EXPECT_EQ(end_of("G28\r\r\nG1 X9\r\n; <IceSL Sep  8 2021>\r\n"), 4);
}

}  // namespace
}  // namespace understudy::rehearsal

#include "report/recorded/rehearsal_comparison.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/output_file.h"
#include "report/comparison_json.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using rehearsal::Severity;
using ::testing::HasSubstr;

rehearsal::FindingGroup group(const std::string& kind, int count, int first_line, int last_line,
                              Severity severity = Severity::error) {
  rehearsal::FindingGroup group;
  group.worst = {kind, severity, first_line, 1.0, 0.3, 0.2, "mm", kind + " at its worst"};
  group.count = count;
  group.first_line = first_line;
  group.last_line = last_line;
  return group;
}

/// Two results that are the same.
class Comparison : public testing::Test {
 protected:
  Comparison() : a_(result("a")), b_(result("b")) {}
  RecordedRehearsal result(const std::string& name) const {
    std::filesystem::create_directories(folder_ / name);
    write_file(folder_ / name / "trace.csv", "time_s\n0\n1\n");
    RecordedRehearsal made;
    made.folder = folder_ / name;
    made.run.inputs_sha256 = "same";
    made.run.go = true;
    made.grade = rehearsal::Grade::go;
    made.inputs = {{"seed", "4"}, {"engine", "mujoco"}};
    made.figures = {{"gap.start_mm", 0.13}, {"print.duration_s", 6.3}, {"accuracy.tip_max_um", 200.0}};
    return made;
  }
  RehearsalComparison compared() const { return compare_rehearsals(a_, b_); }
  FindingChange only_change() const {
    const auto findings = compared().findings;
    return findings.size() == 1 ? findings[0].change : FindingChange::same;
  }

  TemporaryFolder folder_;
  RecordedRehearsal a_, b_;
};

TEST_F(Comparison, EqualResultsDoNotDiffer) {
  const RehearsalComparison same = compared();
  EXPECT_FALSE(same.differs());
  EXPECT_EQ(same.figures_same, 3u);
  EXPECT_EQ(comparison_sentence(same), "The results are the same; all inputs are the same");
}

TEST_F(Comparison, InputsAloneAreNoChangeOfTheResult) {
  b_.inputs = {{"seed", "5"}, {"engine", "mujoco"}, {"--gap-control", "off"}};
  b_.run.inputs_sha256 = "other";
  const RehearsalComparison other = compared();
  EXPECT_FALSE(other.differs());
  ASSERT_EQ(other.inputs.size(), 2u);
  EXPECT_EQ(other.inputs[0].name, "--gap-control");
  EXPECT_FALSE(other.inputs[0].a.has_value());
  EXPECT_EQ(*other.inputs[1].b, "5");
  EXPECT_THAT(comparison_sentence(other), HasSubstr("inputs differ in --gap-control, seed"));
}

TEST_F(Comparison, FindingsAreNewGoneMoreFewerElsewhereOrOfAnotherValue) {
  b_.findings = {group("gap", 2, 10, 12)};
  EXPECT_EQ(only_change(), FindingChange::added);
  EXPECT_TRUE(compared().differs());
  a_.findings = {group("gap", 2, 10, 12)};
  EXPECT_EQ(only_change(), FindingChange::same);
  EXPECT_FALSE(compared().differs());
  a_.findings = {group("gap", 1, 10, 10)};
  EXPECT_EQ(only_change(), FindingChange::more);
  a_.findings = {group("gap", 3, 10, 12)};
  EXPECT_EQ(only_change(), FindingChange::fewer);
  a_.findings = {group("gap", 2, 8, 12)};
  EXPECT_EQ(only_change(), FindingChange::moved);
  a_.findings = {group("gap", 2, 10, 12)};
  a_.findings[0].worst.message = "less bad";
  EXPECT_EQ(only_change(), FindingChange::changed);
  b_.findings.clear();
  EXPECT_EQ(only_change(), FindingChange::gone);
}

TEST_F(Comparison, GroupsOfOneKindCountTogetherAndSeveritiesApart) {
  a_.findings = {group("axis_velocity", 2, 7, 9), group("axis_velocity", 3, 4, 4),
                 group("axis_velocity", 1, 2, 2, Severity::warning)};
  const auto findings = compared().findings;
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].a.count, 5);
  EXPECT_EQ(findings[0].a.first_line, 4);
  EXPECT_EQ(findings[0].a.last_line, 9);
  EXPECT_EQ(findings[1].severity, Severity::warning);
}

TEST_F(Comparison, FiguresThatDifferStandInTheOrderOfTheSummaryWithTheirDifference) {
  b_.figures = {{"gap.start_mm", 0.15},
                {"print.duration_s", 6.3},
                {"accuracy.tip_max_um", 150.0},
                {"sag.strands", 2.0}};
  const RehearsalComparison other = compared();
  ASSERT_EQ(other.figures.size(), 3u);
  EXPECT_EQ(other.figures[0].metric, "accuracy.tip_max_um");
  EXPECT_DOUBLE_EQ(*difference_of(other.figures[0]), -50);
  EXPECT_EQ(other.figures[1].metric, "gap.start_mm");
  EXPECT_EQ(other.figures[2].metric, "sag.strands");
  EXPECT_FALSE(difference_of(other.figures[2]).has_value());
  EXPECT_EQ(other.figures_same, 1u);
  EXPECT_TRUE(other.differs());
}

TEST_F(Comparison, CurvesThatDifferAreToldWithTheirLine) {
  write_file(folder_ / "b" / "trace.csv", "time_s\n0\n2\n");
  EXPECT_EQ(compared().curves, "from byte 10, line 3, on");
  EXPECT_TRUE(compared().differs());
}

TEST_F(Comparison, TheJsonHoldsBothValuesAndLeavesOutWhatIsAbsent) {
  b_.grade = rehearsal::Grade::no_go;
  b_.run.go = false;
  b_.figures["gap.start_mm"] = 0.15;
  b_.figures["sag.strands"] = 2.0;
  b_.findings = {group("gap", 2, 10, 12)};
  const auto json = nlohmann::json::parse(comparison_json(compared(), a_, b_));
  EXPECT_EQ(json.at("schema"), "understudy.comparison/1");
  EXPECT_EQ(json.at("differs"), true);
  EXPECT_EQ(json.at("a").at("verdict"), "go");
  EXPECT_EQ(json.at("b").at("verdict"), "no-go");
  const auto& gap = json.at("figures").at("differ").at(0);
  EXPECT_EQ(gap.at("figure"), "gap.start_mm");
  EXPECT_EQ(gap.at("change"), 0.02);
  EXPECT_FALSE(json.at("figures").at("differ").at(1).contains("a"));
  const auto& finding = json.at("findings").at(0);
  EXPECT_EQ(finding.at("change"), "new");
  EXPECT_EQ(finding.at("a").at("count"), 0);
  EXPECT_EQ(finding.at("b").at("last_line"), 12);
}

}  // namespace
}  // namespace understudy::report

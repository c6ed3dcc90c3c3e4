#include "regression/golden_file.h"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::regression {
namespace {

using ::testing::HasSubstr;

Scenario named(const std::string& file) {
  Scenario scenario;
  scenario.file = file;
  return scenario;
}

const Metrics kRun{{"verdict", "go"},
                   {"gap.start_mm", 0.134198},
                   {"gap.in_band_fraction", 0.75},
                   {"findings.count", 3.0},
                   {"timing.wall_s", 1.5},
                   {"provenance.machine_sha256", "ab"},
                   {"registration.refused", ""},
                   {"accuracy.tip_max_um", 18.2}};

std::vector<Expectation> read_back(const std::string& text) {
  const TemporaryFolder folder;
  write_file(folder / "a.yaml", text);
  return load_golden(folder / "a.yaml");
}

const Expectation& of(const std::vector<Expectation>& golden, const std::string& metric) {
  const auto found = std::ranges::find(golden, metric, &Expectation::metric);
  if (found == golden.end()) throw std::runtime_error(metric + " is not there");
  return *found;
}

TEST(GoldenFile, StandsBesideTheScenarios) {
  EXPECT_EQ(golden_file_of("scenarios/a.yaml"), "scenarios/golden/a.yaml");
}

TEST(GoldenFile, HoldsWhatDoesNotDependOnTheComputer) {
  const auto golden = read_back(golden_text(named("a.yaml"), kRun, {}));
  EXPECT_EQ(golden.size(), 5);
  EXPECT_EQ(std::get<std::string>(*of(golden, "verdict").equals), "go");
  EXPECT_EQ(std::get<double>(*of(golden, "gap.start_mm").equals), 0.134198);
  EXPECT_EQ(of(golden, "gap.start_mm").tolerance, 0.001);
  EXPECT_EQ(of(golden, "gap.start_mm").unit, "mm");
  EXPECT_EQ(of(golden, "accuracy.tip_max_um").tolerance, 1);
  EXPECT_EQ(of(golden, "gap.in_band_fraction").tolerance, 0.001);
  EXPECT_EQ(of(golden, "findings.count").tolerance, 0) << "counts are exact";
}

TEST(GoldenFile, KeepsTheChoiceAndTheTolerancesOfTheFileBefore) {
  const auto before = read_back(
      "golden: 1\nexpect:\n  - {metric: gap.start_mm, equals: 0.1, tolerance: 0.02, unit: mm, source: "
      "golden}\n");
  const auto golden = read_back(golden_text(named("a.yaml"), kRun, before));
  ASSERT_EQ(golden.size(), 1);
  EXPECT_EQ(std::get<double>(*golden[0].equals), 0.134198);
  EXPECT_EQ(golden[0].tolerance, 0.02);
}

TEST(GoldenFile, RefusesAnotherVersionAndABoundThatIsNoFigure) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read_back(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string entry = "expect:\n  - {metric: findings.count, equals: 1, source: golden}\n";
  EXPECT_EQ(message("golden: 1\n" + entry), "");
  EXPECT_THAT(message("golden: 2\n" + entry), HasSubstr("a.yaml:1"));
  EXPECT_THAT(message("golden: 2\n" + entry), HasSubstr("golden is version 2, where this program reads 1"));
  EXPECT_THAT(message(entry), HasSubstr("golden"));
  EXPECT_THAT(message("golden: 1\nexpect:\n  - {metric: findings.count, max: 1, source: golden}\n"),
              HasSubstr("no 'equals'"));
}

}  // namespace
}  // namespace understudy::regression

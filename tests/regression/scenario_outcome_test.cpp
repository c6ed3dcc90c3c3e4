#include "regression/scenario_outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "regression/scenario_file.h"
#include "tests/temporary_folder.h"

namespace understudy::regression {
namespace {

using ::testing::HasSubstr;

Scenario bottle() { return load_scenario(UNDERSTUDY_SOURCE_DIR "/scenarios/song-bottle.yaml"); }

Scenario series_of_two() {
  Scenario scenario = bottle();
  Expectation wanted;
  wanted.metric = "gap.start_mm";
  wanted.statistic = Statistic::max;
  wanted.max = 0.2;
  wanted.unit = "mm";
  scenario.machines = MachineSeries{1, 2, {wanted}};
  return scenario;
}

RecordedOutcome read_back(const std::string& text) {
  const TemporaryFolder folder;
  write_file(folder / "a.yaml", text);
  return load_outcome(folder / "a.yaml");
}

TEST(ScenarioOutcome, AFileIsReadBackAsItWas) {
  ScenarioOutcome outcome;
  outcome.run = {{"verdict", "go"},
                 {"gap.start_mm", 0.134198},
                 {"collision.closest", ""},
                 {"registration.refused", "a \"tilted\" part"}};
  outcome.machines = {{{"gap.start_mm", 0.15}, {"verdict", "go"}}, {}};
  outcome.error = "line 3: 'x'";
  outcome.error_status = 2;
  outcome.seconds = 1.25;
  const RecordedOutcome read = read_back(outcome_text(series_of_two(), outcome, "abc"));
  EXPECT_EQ(read.inputs, "abc");
  EXPECT_EQ(read.outcome.run, outcome.run);
  ASSERT_EQ(read.outcome.machines.size(), 2);
  EXPECT_EQ(read.outcome.machines[0], (Metrics{{"gap.start_mm", 0.15}})) << "what the series asks for";
  EXPECT_TRUE(read.outcome.machines[1].empty());
  EXPECT_EQ(read.outcome.error, outcome.error);
  EXPECT_EQ(read.outcome.error_status, 2);
  EXPECT_EQ(read.outcome.seconds, 1.25);
}

TEST(ScenarioOutcome, AnotherVersionIsRefused) {
  std::string text = outcome_text(bottle(), {{{"verdict", "go"}}, {}, {}, 0, 0}, "abc");
  text.replace(text.find("outcome: 1"), 10, "outcome: 7");
  try {
    read_back(text);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("outcome is version 7, where this program reads 1"));
  }
}

TEST(ScenarioOutcome, InputsAreThoseOfTheRunAndNoExpectation) {
  const std::string inputs = outcome_inputs(bottle(), "");
  EXPECT_EQ(inputs.size(), 64);
  Scenario stricter = bottle();
  stricter.expect.front().source = "another";
  EXPECT_EQ(outcome_inputs(stricter, ""), inputs);
  Scenario other = bottle();
  ++other.seed;
  EXPECT_NE(outcome_inputs(other, ""), inputs);
  EXPECT_NE(outcome_inputs(series_of_two(), ""), inputs);
  Scenario longer = series_of_two();
  longer.machines->seed_last = 3;
  EXPECT_NE(outcome_inputs(longer, ""), outcome_inputs(series_of_two(), ""));
  EXPECT_NE(outcome_inputs(bottle(), "plan"), inputs);
  other.program = "/nonexistent.gcode";
  EXPECT_EQ(outcome_inputs(other, ""), "");
}

TEST(ScenarioOutcome, ChangesLeaveOutWhatDiffersFromRunToRun) {
  const Metrics before{{"gap.start_mm", 0.134198},
                       {"timing.wall_s", 1.0},
                       {"verdict", "go"},
                       {"gap.frames", 20.0},
                       {"provenance.inputs_sha256", "a"}};
  const Metrics after{{"gap.start_mm", 0.151},
                      {"timing.wall_s", 2.0},
                      {"verdict", "no-go"},
                      {"provenance.inputs_sha256", "b"},
                      {"sag.max_um", 3.0}};
  std::vector<std::string> told;
  for (const MetricChange& change : changes(before, after)) told.push_back(text_of(change));
  EXPECT_THAT(told, ::testing::ElementsAre("gap.frames was 20, is absent",
                                           "gap.start_mm was 0.134198 mm, is 0.151 mm",
                                           "sag.max_um was absent, is 3 um", "verdict was go, is no-go"));
  EXPECT_TRUE(changes(before, before).empty());
}

}  // namespace
}  // namespace understudy::regression

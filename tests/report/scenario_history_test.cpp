#include "report/scenario_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::report {
namespace {

regression::ScenarioResult result() {
  regression::ScenarioResult result;
  result.name = "bottle \"b\"";
  result.seconds = 2.5;
  regression::Check check;
  check.ok = true;
  check.name = "gap.start_mm <= 0.2 mm";
  check.value = 0.134198;
  regression::Check word = check;
  word.name = "verdict = go";
  word.value = std::string("go");
  result.checks = {check, word};
  return result;
}

TEST(ScenarioHistory, ALineIsReadBack) {
  const std::vector results{result()};
  const std::string line = history_line("2026-01-02T03:04:05Z", results);
  const auto runs = read_history(line + line, "history.jsonl");
  ASSERT_EQ(runs.size(), 2);
  EXPECT_EQ(runs[1].time, "2026-01-02T03:04:05Z");
  const PastScenario& past = runs[1].scenarios.at("bottle \"b\"");
  EXPECT_TRUE(past.passed);
  EXPECT_EQ(past.seconds, 2.5);
  EXPECT_EQ(past.values, (std::map<std::string, double>{{"gap.start_mm <= 0.2 mm", 0.134198}}));
}

TEST(ScenarioHistory, ALastLineThatWasCutOffDoesNotCountAndAnotherThatIsNoneIsRefused) {
  const std::vector results{result()};
  const std::string line = history_line("t", results);
  EXPECT_EQ(read_history(line + line.substr(0, 20), "h").size(), 1);
  for (const std::string& bad :
       {std::string("{}\n"), std::string("notes\n"), std::string(5000, '[') + "\n"}) {
    try {
      read_history(line + bad + line, "h");
      ADD_FAILURE() << bad.substr(0, 10);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::StartsWith("h:2: not a line of a scenario history"));
    }
  }
}

}  // namespace
}  // namespace understudy::report

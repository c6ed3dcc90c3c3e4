#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regression/scenario_checks.h"

namespace understudy::regression {
namespace {

using testing::HasSubstr;

Expectation expectation(const std::string& metric) {
  Expectation e;
  e.metric = metric;
  e.unit = metric_unit(metric);
  e.source = "Song 2015, 3.3";
  e.line = 14;
  return e;
}

Scenario scenario_with(const Expectation& e) {
  Scenario scenario;
  scenario.file = "scenarios/song-bottle.yaml";
  scenario.name = "song-bottle";
  scenario.expect = {e};
  return scenario;
}

Check check_run(const Expectation& e, const Metrics& run) { return evaluate(scenario_with(e), run, {})[0]; }

// Machines with seeds from 1; a NaN stands for a machine without the figure.
Check check_machines(Expectation e, Statistic statistic, const std::vector<double>& values) {
  e.statistic = statistic;
  Scenario scenario = scenario_with(e);
  scenario.expect.clear();
  scenario.machines = MachineSeries{1, values.size(), {e}};
  std::vector<Metrics> machines;
  for (const double v : values) machines.push_back(std::isnan(v) ? failed_run(3) : Metrics{{e.metric, v}});
  return evaluate(scenario, {}, machines)[0];
}

TEST(ScenarioChecks, BoundsIncludeTheirEnds) {
  Expectation e = expectation("gap.start_mm");
  e.min = 0.1;
  e.max = 0.2;
  for (const double inside : {0.1, 0.15, 0.2})
    EXPECT_TRUE(check_run(e, {{"gap.start_mm", inside}}).ok) << inside;
  for (const double outside : {0.099999, 0.200001})
    EXPECT_FALSE(check_run(e, {{"gap.start_mm", outside}}).ok);
}

TEST(ScenarioChecks, AFailureNamesValueBoundPlaceAndSource) {
  Expectation e = expectation("gap.start_mm");
  e.min = 0.1;
  e.max = 0.2;
  const Check check = check_run(e, {{"gap.start_mm", 0.412}});
  EXPECT_EQ(check.name, "gap.start_mm in 0.1..0.2 mm");
  EXPECT_EQ(check.message, "gap.start_mm is 0.412 mm, above 0.2 mm (song-bottle.yaml:14; Song 2015, 3.3)");
  EXPECT_EQ(std::get<double>(*check.value), 0.412);
}

TEST(ScenarioChecks, EqualityHasATolerance) {
  Expectation e = expectation("print.duration_s");
  e.equals = 63.0;
  e.tolerance = 0.5;
  EXPECT_TRUE(check_run(e, {{"print.duration_s", 63.5}}).ok);
  EXPECT_FALSE(check_run(e, {{"print.duration_s", 63.51}}).ok);
  e.tolerance = 0;
  EXPECT_FALSE(check_run(e, {{"print.duration_s", 63.0001}}).ok);
}

TEST(ScenarioChecks, WordsMustBeEqual) {
  Expectation e = expectation("verdict");
  e.equals = std::string("go");
  EXPECT_TRUE(check_run(e, {{"verdict", std::string("go")}}).ok);
  const Check check = check_run(e, {{"verdict", std::string("no-go")}});
  EXPECT_FALSE(check.ok);
  EXPECT_THAT(check.message, HasSubstr("verdict is no-go, not go"));
}

TEST(ScenarioChecks, AnAbsentFigureNeverPasses) {
  Expectation e = expectation("findings.collision.count");
  e.max = 0;
  const Check check = check_run(e, failed_run(3));
  EXPECT_FALSE(check.ok);
  EXPECT_FALSE(check.value);
  EXPECT_THAT(check.message, HasSubstr("absent"));
}

// Expected values by numpy's definitions: np.percentile([1..5], 95) = 4.8, np.median([1, 2, 3, 10]) = 2.5.
TEST(ScenarioChecks, StatisticsAreTheUsualOnes) {
  Expectation e = expectation("accuracy.tip_max_um");
  e.min = 0;
  const auto value = [&](Statistic s, const std::vector<double>& v) {
    return std::get<double>(*check_machines(e, s, v).value);
  };
  EXPECT_EQ(value(Statistic::min, {3, 1, 2}), 1);
  EXPECT_EQ(value(Statistic::max, {3, 1, 2}), 3);
  EXPECT_EQ(value(Statistic::mean, {3, 1, 2, 4}), 2.5);
  EXPECT_EQ(value(Statistic::median, {10, 1, 3, 2}), 2.5);
  EXPECT_EQ(value(Statistic::median, {10, 1, 3}), 3);
  EXPECT_DOUBLE_EQ(value(Statistic::p95, {5, 4, 3, 2, 1}), 4.8);
  EXPECT_EQ(value(Statistic::p95, {7}), 7);
}

TEST(ScenarioChecks, AnExtremeNamesItsMachine) {
  Expectation e = expectation("findings.collision.count");
  e.max = 0;
  const Check check = check_machines(e, Statistic::max, {0, 0, 2, 0});
  EXPECT_FALSE(check.ok);
  EXPECT_THAT(check.message, HasSubstr("is 2 (seed 3), above 0"));
}

TEST(ScenarioChecks, AFractionNamesTheMachinesOutside) {
  Expectation e = expectation("gap.start_mm");
  e.within_min = 0.1;
  e.within_max = 0.2;
  e.min = 0.75;
  EXPECT_TRUE(check_machines(e, Statistic::fraction_within, {0.1, 0.2, 0.15, 0.5}).ok);
  const Check check = check_machines(e, Statistic::fraction_within, {0.1, 0.21, 0.15, 0.5});
  EXPECT_FALSE(check.ok);
  EXPECT_EQ(
      check.message,
      "fraction with gap.start_mm in 0.1..0.2 mm over seeds 1-4 is 0.5, below 0.75, outside: seeds 2, 4 "
      "(song-bottle.yaml:14; Song 2015, 3.3)");
}

// A machine without the figure is held against the bound, whichever side it is on.
TEST(ScenarioChecks, AbsentFiguresCannotHelpAFraction) {
  const double absent = std::nan("");
  Expectation e = expectation("gap.start_mm");
  e.within_min = 0.1;
  e.within_max = 0.2;
  e.min = 0.9;
  EXPECT_FALSE(check_machines(e, Statistic::fraction_within, {0.15, absent}).ok);
  e.min.reset();
  e.max = 0.5;
  EXPECT_TRUE(check_machines(e, Statistic::fraction_within, {0.15, 0.5}).ok);
  EXPECT_FALSE(check_machines(e, Statistic::fraction_within, {0.15, 0.5, absent}).ok);
}

TEST(ScenarioChecks, AbsentFiguresFailEveryOtherStatistic) {
  Expectation e = expectation("gap.start_mm");
  e.min = 0;
  for (const Statistic s :
       {Statistic::min, Statistic::max, Statistic::mean, Statistic::median, Statistic::p95}) {
    const Check check = check_machines(e, s, {0.1, std::nan(""), 0.2});
    EXPECT_FALSE(check.ok);
    EXPECT_THAT(check.message, HasSubstr("absent from 1 of 3 machines (seed 2)"));
  }
}

TEST(ScenarioChecks, TooFewMachinesAreOurOwnMistake) {
  Scenario scenario = scenario_with(expectation("gap.start_mm"));
  scenario.expect.clear();
  scenario.machines = MachineSeries{1, 3, {}};
  EXPECT_THROW(evaluate(scenario, {}, std::vector<Metrics>(2)), std::logic_error);
}

}  // namespace
}  // namespace understudy::regression

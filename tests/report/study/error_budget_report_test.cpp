#include "report/study/error_budget_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/report/study/sample_budget.h"

namespace understudy::report {
namespace {

using sim::TruthGroup;
using testing::HasSubstr;

TEST(ErrorBudgetReport, JsonHasSharesWithIntervalsTheLargestTotalFirst) {
  const auto json = nlohmann::json::parse(budget_json(sample_budget()));
  EXPECT_EQ(json.at("schema"), "understudy.budget/1");
  EXPECT_EQ(json.at("rehearsals"), 40);
  EXPECT_EQ(json.at("stopped_early"), 2);
  const auto& start = json.at("quantities").at(0);
  EXPECT_EQ(start.at("quantity"), "start_gap_error_um");
  EXPECT_EQ(start.at("groups").at(0).at("group"), "mounting");
  EXPECT_EQ(start.at("groups").at(0).at("total").at("high"), 0.95);
  EXPECT_EQ(start.at("groups").at(1).at("first").at("low"), -0.05);
  EXPECT_THAT(start.at("groups").at(0).at("procedure"), HasSubstr("calibrate gap-sensor"));
  const auto& tip = json.at("quantities").at(1);
  EXPECT_EQ(tip.at("not_shared_out"), "it is the same on all machines");
  EXPECT_FALSE(tip.contains("groups"));
}

TEST(ErrorBudgetReport, TheTableSaysWhatWasLeftOutAndWhatToDo) {
  const std::string table = budget_table(sample_budget());
  EXPECT_THAT(table,
              HasSubstr("8 samples x (3 groups + 2) = 40 rehearsals of machines as built manufactured"));
  EXPECT_THAT(table, HasSubstr("2 of 40 rehearsals stopped early"));
  EXPECT_THAT(table, HasSubstr("7 of 8 samples"));
  EXPECT_THAT(table, HasSubstr("0.80 [ 0.60,  0.95]"));
  EXPECT_THAT(table, HasSubstr("not shared out: it is the same on all machines"));
  EXPECT_LT(table.find("mounting"), table.find("geometry"));
}

TEST(ErrorBudgetReport, CsvHasALineForEachGroupAndForEachRehearsal) {
  EXPECT_THAT(budget_csv(sample_budget()), HasSubstr("start_gap_error_um,mounting,7,0.700000,"));
  const std::string runs = budget_runs_csv(sample_budget());
  EXPECT_THAT(runs, HasSubstr("sample,world,stopped,start_gap_error_um,tip_error_um\n"));
  EXPECT_THAT(runs, HasSubstr("0,a,0,1.500000"));
  EXPECT_THAT(runs, HasSubstr("0,mounting,1,,"));  // no answer is no number
}

TEST(ErrorBudgetReport, AShareThatRoundsToZeroHasNoSign) {
  EXPECT_EQ(share_text(-0.004), "0.00");
  EXPECT_EQ(share_text(-0.006), "-0.01");
  EXPECT_EQ(share_text(0.996), "1.00");
}

TEST(ErrorBudgetReport, EveryGroupHasAWordAndAProcedure) {
  for (const TruthGroup group : sim::all_truth_groups())
    for (const char* set : {"sampled", "manufactured", "calibrated"})
      EXPECT_FALSE(remedy_of(group, set).procedure.empty()) << to_string(group);
}

}  // namespace
}  // namespace understudy::report

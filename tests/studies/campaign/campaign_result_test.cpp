#include "studies/campaign/campaign_result.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::studies {
namespace {

Campaign grid_of(std::uint64_t seeds) {
  Campaign campaign;
  campaign.scenarios = {"a.yaml"};
  campaign.seed_last = seeds;
  campaign.parameters.resize(1);
  campaign.parameters[0].key = "machine.gap.aim_mm";
  campaign.parameters[0].values = {"0.12", "0.15"};
  campaign.metrics = {"gap.start_mm"};
  return campaign;
}

RunRow row_of(const CampaignRun& run, RunEnd end, double start_mm, double gap_findings, double warnings) {
  RunRow row;
  row.index = run.index;
  row.seed = run.seed;
  row.scenario = "a";
  row.end = end;
  if (!row.answered()) return row;
  row.metrics = {
      {"gap.start_mm", start_mm}, {"findings.gap.count", gap_findings}, {"findings.warning.count", warnings}};
  return row;
}

/// Rows as `make` has them.
template <typename Make>
RowSource rows_of(const RunPlan& plan, const Make& make) {
  return [&plan, make](std::uint64_t begin, std::uint64_t end) {
    std::vector<RunRow> rows;
    for (std::uint64_t i = begin; i < end; ++i) rows.push_back(make(plan.run(i)));
    return rows;
  };
}

TEST(CampaignResult, CountsEachGroupByItself) {
  const Campaign campaign = grid_of(10);
  const RunPlan plan(campaign);
  // At the first point every machine is GO, those of even seeds with a warning; at the second those of seeds
  // up to 4 find a gap, and that of seed 9 has no answer.
  const CampaignResult result = evaluate(
      campaign, plan, 10, rows_of(plan, [](const CampaignRun& run) {
        if (run.point == 0) return row_of(run, RunEnd::go, 0.12, 0, run.seed % 2 == 0 ? 1 : 0);
        if (run.seed == 9) return row_of(run, RunEnd::refused, 0, 0, 0);
        return run.seed <= 4 ? row_of(run, RunEnd::no_go, 0.2, 3, 0) : row_of(run, RunEnd::go, 0.15, 0, 0);
      }));
  ASSERT_EQ(result.groups.size(), 2u);
  const CampaignGroup &first = result.groups[0], &second = result.groups[1];
  EXPECT_EQ(first.values, ParameterValues{"0.12"});
  EXPECT_EQ(first.go.count, 10u);
  EXPECT_EQ(first.clean.count, 5u);
  EXPECT_EQ(second.runs, 10u);
  EXPECT_EQ(second.no_answer, 1u);
  EXPECT_EQ(second.go.runs, 9u);
  EXPECT_EQ(second.go.count, 5u);
  EXPECT_EQ(second.findings.at("gap").count, 4u);
  EXPECT_EQ(second.findings.at("gap").runs, 9u);
  EXPECT_FALSE(second.findings.contains("collision"));  // nobody looked
  EXPECT_EQ(second.metrics[0].runs, 9u);
  EXPECT_EQ(second.metrics[0].quantiles[1].value, 0.15);
}

TEST(CampaignResult, StopsAtTheFirstLookWhoseIntervalsAreNarrow) {
  Campaign campaign = grid_of(400);
  campaign.stop = StopRule{0.1, 25};
  const RunPlan plan(campaign);
  const RowSource all_go =
      rows_of(plan, [](const CampaignRun& run) { return row_of(run, RunEnd::go, 0.13, 0, 0); });
  // Of n machines that are all GO the interval begins at (a / 2)^(1 / n), with a = 5 % shared by the looks.
  const auto looks = static_cast<double>(plan.looks().size());
  for (const std::uint64_t n : plan.looks())
    EXPECT_EQ(narrow_enough(campaign, plan, n, all_go),
              1 - std::pow(0.025 / looks, 1.0 / static_cast<double>(n)) <= 0.2)
        << n;
  const RowSource half = rows_of(plan, [](const CampaignRun& run) {
    return row_of(run, run.seed % 2 == 0 ? RunEnd::go : RunEnd::no_go, 0.13, 0, 0);
  });
  EXPECT_FALSE(narrow_enough(campaign, plan, 50, half));
  EXPECT_TRUE(evaluate(campaign, plan, 50, half).stopped_early);
}

TEST(CampaignResult, AnIntervalThatStopsACampaignHoldsTheTruthAsOftenAsItSays) {
  Campaign campaign = grid_of(256);
  campaign.parameters.clear();
  campaign.metrics.clear();
  campaign.stop = StopRule{0.12, 16};
  const RunPlan plan(campaign);
  constexpr int kTrials = 400;
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const RowSource rows = rows_of(plan, [trial](const CampaignRun& run) {
      const bool go = Random(static_cast<std::uint64_t>(trial) * 1000 + run.seed, "trial").uniform() < 0.8;
      return row_of(run, go ? RunEnd::go : RunEnd::no_go, 0, 0, 0);
    });
    std::uint64_t rounds = 0;
    for (const std::uint64_t look : plan.looks()) {
      rounds = look;
      if (narrow_enough(campaign, plan, look, rows)) break;
    }
    const Interval p = evaluate(campaign, plan, rounds, rows).groups[0].go.probability;
    held += p.low <= 0.8 && 0.8 <= p.high ? 1 : 0;
  }
  EXPECT_GT(held, 0.92 * kTrials);  // 95 % less three sigma of 400 trials
}

TEST(CampaignResult, SharesAFiguresVarianceOut) {
  Campaign campaign = grid_of(512);
  campaign.plan = SamplingPlan::sensitivity;
  campaign.parameters.resize(2);
  campaign.parameters[0].to = campaign.parameters[1].to = 1;
  campaign.parameters[1].key = "machine.gap.standoff_mm";
  campaign.parameters[0].values = campaign.parameters[1].values = {};
  const RunPlan plan(campaign);
  // y = 2 p + q + m: variances 4, 1 and, of the machine's uniform number, 1: 4/6, 1/6 and 1/6 of it.
  const CampaignResult result =
      evaluate(campaign, plan, plan.rounds(), rows_of(plan, [](const CampaignRun& run) {
                 const double machine = Random(run.seed, "machine").uniform();
                 return row_of(run, RunEnd::go,
                               2 * std::stod(run.values[0]) + std::stod(run.values[1]) + machine, 0, 0);
               }));
  EXPECT_EQ(result.groups[0].runs, 512u);  // two machines of each pair
  ASSERT_EQ(result.sensitivities.size(), 2u);
  const Sensitivity& start = result.sensitivities[1];
  EXPECT_EQ(start.figure, "gap.start_mm");
  ASSERT_EQ(start.shares.size(), 3u);
  const double truth[] = {4.0 / 6, 1.0 / 6, 1.0 / 6};
  for (std::size_t g = 0; g < 3; ++g) {
    // 256 pairs: an index scatters by about 1 / sqrt(256) = 0.06.
    EXPECT_NEAR(start.shares[g].first.value, truth[g], 0.15) << g;
    EXPECT_NEAR(start.shares[g].total.value, truth[g], 0.15) << g;
  }
  EXPECT_EQ(result.sensitivities[0].why, "it is the same in all runs");
}

}  // namespace
}  // namespace understudy::studies

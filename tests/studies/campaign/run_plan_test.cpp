#include "studies/campaign/run_plan.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::studies {
namespace {

CampaignParameter parameter(const std::string& key, std::vector<std::string> values = {}) {
  CampaignParameter one;
  one.key = key;
  one.values = std::move(values);
  one.from = 0, one.to = 1;
  return one;
}

Campaign campaign_of(SamplingPlan plan) {
  Campaign campaign;
  campaign.scenarios = {"a.yaml", "b.yaml"};
  campaign.seed_first = 11, campaign.seed_last = 30;
  campaign.plan = plan;
  const bool grid = plan == SamplingPlan::grid;
  campaign.parameters = {
      parameter("p", grid ? std::vector<std::string>{"1", "2", "3"} : std::vector<std::string>{}),
      parameter("q", grid ? std::vector<std::string>{"x"} : std::vector<std::string>{})};
  return campaign;
}

TEST(RunPlan, EveryGroupOfAGridHasEverySeedOnce) {
  const Campaign campaign = campaign_of(SamplingPlan::grid);
  const RunPlan plan(campaign);
  EXPECT_EQ(plan.size(), 2u * 3 * 20);
  std::map<std::size_t, std::set<std::uint64_t>> seeds;
  for (std::uint64_t i = 0; i < plan.size(); ++i) seeds[plan.group_of(plan.run(i))].insert(plan.run(i).seed);
  EXPECT_EQ(seeds.size(), plan.groups());
  for (const auto& [group, of_group] : seeds) EXPECT_EQ(of_group.size(), 20u) << group;
}

TEST(RunPlan, TheFirstRunsHaveTheFirstSeedsOfAllGroups) {
  const Campaign campaign = campaign_of(SamplingPlan::grid);
  const RunPlan plan(campaign);
  std::set<std::size_t> groups;
  for (std::uint64_t i = 0; i < plan.runs_a_round(); ++i) {
    EXPECT_EQ(plan.run(i).seed, 11u);
    groups.insert(plan.group_of(plan.run(i)));
  }
  EXPECT_EQ(groups.size(), plan.groups());
}

TEST(RunPlan, SampledPlansHaveANewMachineAtEachPoint) {
  for (const SamplingPlan word : {SamplingPlan::latin_hypercube, SamplingPlan::sobol}) {
    const Campaign campaign = campaign_of(word);
    const RunPlan plan(campaign);
    EXPECT_EQ(plan.size(), 2u * 20);
    EXPECT_EQ(plan.groups(), 2u);
    EXPECT_EQ(plan.run(0).values, plan.run(1).values);  // both scenarios at the same point
    EXPECT_NE(plan.run(0).values, plan.run(2).values);
    EXPECT_EQ(plan.run(2).seed, 12u);
  }
}

TEST(RunPlan, APairExchangesOneFactorAfterTheOther) {
  const Campaign campaign = campaign_of(SamplingPlan::sensitivity);
  const RunPlan plan(campaign);
  EXPECT_EQ(plan.rounds(), 10u);
  EXPECT_EQ(plan.size(), 10u * 2 * 5);
  const auto world = [&](std::uint64_t w) { return plan.run(5 + w); };  // of the second scenario, first pair
  const CampaignRun a = world(0), b = world(1);
  EXPECT_EQ(a.scenario, 1u);
  EXPECT_NE(a.seed, b.seed);
  EXPECT_EQ(world(2).values, (ParameterValues{b.values[0], a.values[1]}));
  EXPECT_EQ(world(3).values, (ParameterValues{a.values[0], b.values[1]}));
  EXPECT_EQ(world(2).seed, a.seed);
  EXPECT_EQ(world(4).values, a.values);
  EXPECT_EQ(world(4).seed, b.seed);
  EXPECT_TRUE(plan.counts(a) && plan.counts(b));
  EXPECT_FALSE(plan.counts(world(2)) || plan.counts(world(4)));
}

TEST(RunPlan, LooksDoubleAndEndWithAll) {
  Campaign campaign = campaign_of(SamplingPlan::grid);
  EXPECT_EQ(RunPlan(campaign).looks(), (std::vector<std::uint64_t>{20}));
  campaign.stop = StopRule{0.1, 3};
  EXPECT_EQ(RunPlan(campaign).looks(), (std::vector<std::uint64_t>{3, 6, 12, 20}));
}

TEST(RunPlan, RefusesMoreRunsThanACampaignMayHave) {
  Campaign campaign = campaign_of(SamplingPlan::grid);
  campaign.seed_last = campaign.seed_first + kRunsMax;
  EXPECT_THROW(check_run_count(campaign), InputError);
}

}  // namespace
}  // namespace understudy::studies

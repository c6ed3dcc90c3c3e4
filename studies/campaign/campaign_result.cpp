#include "studies/campaign/campaign_result.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/assert.h"
#include "regression/metrics.h"

namespace understudy::studies {
namespace {

constexpr std::uint64_t kChunk = 4096;  // rows in memory at a time

std::optional<double> number_in(const RunRow& row, const std::string& metric) {
  const auto found = row.metrics.find(metric);
  return found == row.metrics.end() ? std::nullopt : std::optional(std::get<double>(found->second));
}

/// "findings.gap.count" of each kind, by kind.
const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> found;
    for (const std::string& name : row_metrics()) {
      constexpr std::string_view kBegin = "findings.", kEnd = ".count";
      if (!name.starts_with(kBegin) || !name.ends_with(kEnd) || name.size() <= kBegin.size() + kEnd.size())
        continue;
      const std::string kind = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
      if (kind != "error" && kind != "warning") found.push_back(kind);
    }
    return found;
  }();
  return all;
}

/// Of one group, while rows come.
struct Tally {
  CampaignGroup group;
  std::vector<std::vector<double>> values;  // by metric of the campaign
};

void add(const RunRow& row, const Campaign& campaign, Tally& tally) {
  CampaignGroup& group = tally.group;
  ++group.runs;
  if (!row.answered()) {
    ++group.no_answer;
    return;
  }
  const bool go = row.end == RunEnd::go;
  const bool clean = go && number_in(row, "findings.warning.count").value_or(0) == 0;
  for (auto [frequency, is] : {std::pair{&group.go, go}, std::pair{&group.clean, clean}}) {
    ++frequency->runs;
    frequency->count += is ? 1 : 0;
  }
  for (const std::string& kind : kinds())
    if (const auto count = number_in(row, "findings." + kind + ".count")) {
      Frequency& frequency = group.findings[kind];
      ++frequency.runs;
      frequency.count += *count > 0 ? 1 : 0;
    }
  for (std::size_t m = 0; m < campaign.metrics.size(); ++m)
    if (const auto value = number_in(row, campaign.metrics[m])) tally.values[m].push_back(*value);
}

void close(const Campaign& campaign, double go_level, Tally& tally) {
  CampaignGroup& group = tally.group;
  const auto fill = [](Frequency& frequency, double level) {
    frequency.probability = binomial_interval(frequency.count, frequency.runs, level);
  };
  fill(group.go, go_level);
  fill(group.clean, campaign.level);
  for (auto& [kind, frequency] : group.findings) fill(frequency, campaign.level);
  for (std::size_t m = 0; m < campaign.metrics.size(); ++m) {
    const std::string& metric = campaign.metrics[m];
    MetricSpread spread{metric, regression::metric_unit(metric), tally.values[m].size(), {}};
    for (const double share : kQuantileShares)
      spread.quantiles.push_back(quantile_interval(tally.values[m], share, campaign.level, metric));
    group.metrics.push_back(std::move(spread));
  }
}

/// The outputs of one figure, pair by pair, while rows come.
class Outputs {
 public:
  Outputs(std::string scenario, std::string figure)
      : scenario_(std::move(scenario)), figure_(std::move(figure)) {}

  void add(const RunRow& row, std::size_t world, std::size_t worlds) {
    worlds_ = worlds;
    if (world == 0) pair_.assign(worlds, std::nullopt);
    if (row.answered())
      pair_[world] = figure_ == "go" ? (row.end == RunEnd::go ? 1.0 : 0.0) : number_in(row, figure_);
    if (world + 1 == worlds) take_pair();
  }

  Sensitivity result(double level) const {
    Sensitivity sensitivity{scenario_, figure_, outputs_.a.size(), {}, ""};
    if (outputs_.a.size() < 2 || 2 * outputs_.a.size() < pairs_) {
      sensitivity.why =
          fmt::format("only {} of {} pairs have it in every run, less than half", outputs_.a.size(), pairs_);
      return sensitivity;
    }
    Bootstrap bootstrap;
    bootstrap.level = level;
    sensitivity.shares = sobol_indices(outputs_, bootstrap);
    if (sensitivity.shares.empty()) sensitivity.why = "it is the same in all runs";
    return sensitivity;
  }

 private:
  void take_pair() {
    ++pairs_;
    outputs_.mixed.resize(worlds_ - 2);
    if (!std::all_of(pair_.begin(), pair_.end(), [](const auto& value) { return value.has_value(); })) return;
    outputs_.a.push_back(*pair_[0]);
    outputs_.b.push_back(*pair_[1]);
    for (std::size_t g = 0; g + 2 < worlds_; ++g) outputs_.mixed[g].push_back(*pair_[g + 2]);
  }

  std::size_t worlds_ = 0;
  std::string scenario_, figure_;
  std::vector<std::optional<double>> pair_;
  std::size_t pairs_ = 0;
  PickFreeze outputs_;
};

std::vector<Tally> empty_tallies(const Campaign& campaign, const RunPlan& plan) {
  std::vector<Tally> tallies(plan.groups());
  for (Tally& tally : tallies) tally.values.resize(campaign.metrics.size());
  if (campaign.plan == SamplingPlan::grid)
    for (std::size_t g = 0; g < tallies.size(); ++g)
      tallies[g].group.values = plan.grid()[g % plan.grid().size()];
  return tallies;
}

/// Calls `take` with each row up to `rounds`, in order.
void for_each_row(const RunPlan& plan, std::uint64_t rounds, const RowSource& rows,
                  const std::function<void(const RunRow&, const CampaignRun&)>& take) {
  const std::uint64_t end = rounds * plan.runs_a_round();
  for (std::uint64_t begin = 0; begin < end; begin += kChunk) {
    const std::uint64_t stop = std::min(begin + kChunk, end);
    const std::vector<RunRow> chunk = rows(begin, stop);
    UNDERSTUDY_ASSERT(chunk.size() == stop - begin, "every run up to a look has a row");
    for (const RunRow& row : chunk) take(row, plan.run(row.index));
  }
}

/// Bonferroni: an interval that was good enough at some look holds as often as one that was looked at once.
double level_of_looks(double level, std::size_t looks) {
  return 1 - (1 - level) / static_cast<double>(looks);
}

}  // namespace

bool narrow_enough(const Campaign& campaign, const RunPlan& plan, std::uint64_t rounds,
                   const RowSource& rows) {
  if (!campaign.stop) return false;
  std::vector<Frequency> go(plan.groups());
  for_each_row(plan, rounds, rows, [&](const RunRow& row, const CampaignRun& run) {
    if (!plan.counts(run) || !row.answered()) return;
    Frequency& frequency = go[plan.group_of(run)];
    ++frequency.runs;
    frequency.count += row.end == RunEnd::go ? 1 : 0;
  });
  const double level = level_of_looks(campaign.level, plan.looks().size());
  return std::all_of(go.begin(), go.end(), [&](const Frequency& frequency) {
    const Interval interval = binomial_interval(frequency.count, frequency.runs, level);
    return interval.high - interval.low <= 2 * campaign.stop->half_width;
  });
}

CampaignResult evaluate(const Campaign& campaign, const RunPlan& plan, std::uint64_t rounds,
                        const RowSource& rows) {
  CampaignResult result;
  result.rounds = rounds;
  result.planned_rounds = plan.rounds();
  result.runs = rounds * plan.runs_a_round();
  result.planned_runs = plan.size();
  result.stopped_early = rounds < plan.rounds();
  result.looks = plan.looks().size();
  result.go_level = level_of_looks(campaign.level, result.looks);
  std::vector<Tally> tallies = empty_tallies(campaign, plan);
  const bool sensitivity = campaign.plan == SamplingPlan::sensitivity;
  const std::size_t worlds = campaign.parameters.size() + 3;
  std::vector<std::vector<Outputs>> outputs(sensitivity ? campaign.scenarios.size() : 0);
  for_each_row(plan, rounds, rows, [&](const RunRow& row, const CampaignRun& run) {
    Tally& tally = tallies[plan.group_of(run)];
    tally.group.scenario = row.scenario;
    if (plan.counts(run)) add(row, campaign, tally);
    if (!sensitivity) return;
    auto& of_scenario = outputs[run.scenario];
    if (of_scenario.empty()) {
      of_scenario.emplace_back(row.scenario, "go");
      for (const std::string& metric : campaign.metrics) of_scenario.emplace_back(row.scenario, metric);
    }
    for (Outputs& figure : of_scenario) figure.add(row, plan.world_of(run), worlds);
  });
  for (Tally& tally : tallies) {
    close(campaign, result.go_level, tally);
    result.groups.push_back(std::move(tally.group));
  }
  for (const auto& of_scenario : outputs)
    for (const Outputs& figure : of_scenario) result.sensitivities.push_back(figure.result(campaign.level));
  return result;
}

}  // namespace understudy::studies

// What the runs of a campaign say.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "studies/budget/sobol_indices.h"
#include "studies/campaign/campaign.h"
#include "studies/campaign/intervals.h"
#include "studies/campaign/run_plan.h"
#include "studies/campaign/run_row.h"

namespace understudy::studies {

/// How often something was so among the runs that could tell.
struct Frequency {
  std::uint64_t count = 0, runs = 0;
  Interval probability;
};

struct MetricSpread {
  std::string metric, unit;
  std::uint64_t runs = 0;           ///< that have it
  std::vector<Interval> quantiles;  ///< by kQuantileShares
};
constexpr double kQuantileShares[] = {0.05, 0.5, 0.95};

/// Runs on independent built machines, alike in everything else.
struct CampaignGroup {
  std::string scenario;
  ParameterValues values;  ///< of the grid; empty of other plans
  std::uint64_t runs = 0;
  std::uint64_t no_answer = 0;                ///< refused, failed or crashed: in no figure below
  Frequency go;                               ///< with warnings or without
  Frequency clean;                            ///< go without a warning
  std::map<std::string, Frequency> findings;  ///< at least one of this kind
  std::vector<MetricSpread> metrics;
};

/// Which parameter a figure's variance comes from, of a sensitivity campaign.
struct Sensitivity {
  std::string scenario, figure;    ///< "go", or a metric
  std::uint64_t pairs = 0;         ///< all of whose runs have it
  std::vector<GroupShare> shares;  ///< by parameter, and last the built machine; empty: see `why`
  std::string why;
};

struct CampaignResult {
  std::uint64_t runs = 0, planned_runs = 0;
  std::uint64_t rounds = 0, planned_rounds = 0;  ///< machines, or pairs of them
  bool stopped_early = false;                    ///< the intervals were narrow enough
  /// Of P(GO) at this many looks, so that all of them hold together: 1 - (1 - level) / looks.
  double go_level = 0.95;
  std::size_t looks = 1;
  std::vector<CampaignGroup> groups;
  std::vector<Sensitivity> sensitivities;
};

/// Gives the rows from `begin` to before `end`, by index.
using RowSource = std::function<std::vector<RunRow>(std::uint64_t begin, std::uint64_t end)>;

/// `rounds`: those that count; all of their rows must be there. The same rows give the same result.
CampaignResult evaluate(const Campaign& campaign, const RunPlan& plan, std::uint64_t rounds,
                        const RowSource& rows);

/// The intervals of P(GO) after `rounds` are as narrow as the campaign asks.
bool narrow_enough(const Campaign& campaign, const RunPlan& plan, std::uint64_t rounds,
                   const RowSource& rows);

}  // namespace understudy::studies

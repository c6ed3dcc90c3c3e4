// The runs of a campaign, in their order: the first ones are those that a campaign which stops early has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/campaign/campaign.h"
#include "studies/campaign/sampling.h"

namespace understudy::studies {

constexpr std::uint64_t kRunsMax = 10'000'000;
constexpr std::uint64_t kPointsMax = 100'000;  ///< of a grid

/// Throws InputError, at the campaign's file, for more runs or points than that.
void check_run_count(const Campaign& campaign);

struct CampaignRun {
  std::uint64_t index = 0;
  std::size_t scenario = 0;
  std::size_t point = 0;  ///< of the grid; of the other plans the running number of the point
  std::uint64_t seed = 0;
  ParameterValues values;
};

/// Seeds are the outermost order: after each seed all points of all scenarios have run on it, so that the
/// runs of a group are on independent machines, and every group has as many.
class RunPlan {
 public:
  explicit RunPlan(const Campaign& campaign);

  std::uint64_t size() const { return rounds_ * runs_a_round(); }
  CampaignRun run(std::uint64_t index) const;

  /// A round: what runs before the next seed, or pair of seeds, comes.
  std::uint64_t rounds() const { return rounds_; }
  std::uint64_t runs_a_round() const { return scenarios_ * points_a_round_; }
  /// Rounds after each of which the campaign may stop; the last one is all rounds.
  std::vector<std::uint64_t> looks() const;

  /// A scenario at a point of the grid; of the other plans a scenario.
  std::size_t groups() const;
  std::size_t group_of(const CampaignRun& run) const;
  /// Of a sensitivity campaign, of each round: first, second, then the first with one after the other of the
  /// parameters, and at last the built machine, of the second.
  std::size_t world_of(const CampaignRun& run) const;
  bool counts(const CampaignRun& run) const;  ///< in probabilities: its machine and point are as drawn
  /// Of the grid; empty of other plans.
  const std::vector<ParameterValues>& grid() const { return grid_; }

 private:
  ParameterValues drawn(std::uint64_t row) const;

  const Campaign& campaign_;
  std::uint64_t scenarios_ = 1, points_a_round_ = 1, rounds_ = 0;
  std::vector<ParameterValues> grid_;
  std::vector<std::vector<double>> drawn_;  // by sample; of a sensitivity campaign both of a pair in one row
};

}  // namespace understudy::studies

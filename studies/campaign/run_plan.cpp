#include "studies/campaign/run_plan.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/assert.h"

namespace understudy::studies {
namespace {

bool is_sensitivity(const Campaign& campaign) { return campaign.plan == SamplingPlan::sensitivity; }

/// Saturates: what is refused is refused however large.
std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? ~std::uint64_t{0} : product;
}

std::uint64_t grid_size(const Campaign& campaign) {
  std::uint64_t points = 1;
  for (const CampaignParameter& parameter : campaign.parameters)
    if (campaign.plan == SamplingPlan::grid) points = times(points, parameter.values.size());
  return points;
}

/// The first two worlds, and one for each parameter and the built machine.
std::uint64_t worlds_of(const Campaign& campaign) { return campaign.parameters.size() + 3; }

}  // namespace

void check_run_count(const Campaign& campaign) {
  const std::uint64_t points = grid_size(campaign);
  const Place place{campaign.file.string(), 0, 0};
  if (points > kPointsMax)
    throw InputError(place, fmt::format("the grid has {} points, more than {}", points, kPointsMax));
  const std::uint64_t runs = is_sensitivity(campaign) ? times(campaign.seeds() / 2, worlds_of(campaign))
                                                      : times(campaign.seeds(), points);
  const std::uint64_t all = times(runs, campaign.scenarios.size());
  if (all > kRunsMax)
    throw InputError(place, fmt::format("the campaign has {} runs, more than {}", all, kRunsMax));
}

RunPlan::RunPlan(const Campaign& campaign) : campaign_(campaign), scenarios_(campaign.scenarios.size()) {
  const std::size_t dimensions = campaign.parameters.size();
  switch (campaign.plan) {
    case SamplingPlan::grid:
      grid_ = grid_points(campaign.parameters);
      points_a_round_ = grid_.size();
      rounds_ = campaign.seeds();
      break;
    case SamplingPlan::latin_hypercube:
      rounds_ = campaign.seeds();
      drawn_ = latin_hypercube(rounds_, dimensions);
      break;
    case SamplingPlan::sobol:
      rounds_ = campaign.seeds();
      drawn_ = sobol_points(rounds_, dimensions);
      break;
    case SamplingPlan::sensitivity:
      rounds_ = campaign.seeds() / 2;
      points_a_round_ = worlds_of(campaign);
      drawn_ = sobol_points(rounds_, 2 * dimensions);
      break;
  }
}

ParameterValues RunPlan::drawn(std::uint64_t row) const {
  ParameterValues values;
  for (std::size_t p = 0; p < campaign_.parameters.size(); ++p)
    values.push_back(value_text(scaled(campaign_.parameters[p], drawn_[row][p])));
  return values;
}

CampaignRun RunPlan::run(std::uint64_t index) const {
  UNDERSTUDY_ASSERT(index < size(), "a run of the plan");
  CampaignRun run;
  run.index = index;
  const std::uint64_t round = index / runs_a_round(), rest = index % runs_a_round();
  run.scenario = rest / points_a_round_;
  const std::uint64_t inner = rest % points_a_round_;
  run.seed = campaign_.seed_first + round;
  switch (campaign_.plan) {
    case SamplingPlan::grid:
      run.point = inner;
      run.values = grid_[inner];
      return run;
    case SamplingPlan::latin_hypercube:
    case SamplingPlan::sobol:
      run.point = round;
      run.values = drawn(round);
      return run;
    case SamplingPlan::sensitivity:
      break;
  }
  run.point = round * points_a_round_ + inner;
  const std::size_t dimensions = campaign_.parameters.size();
  const bool second = inner == 1, machine_exchanged = inner == dimensions + 2;
  run.seed = campaign_.seed_first + 2 * round + (second || machine_exchanged ? 1 : 0);
  for (std::size_t p = 0; p < dimensions; ++p) {
    const bool from_second = second || inner == p + 2;
    run.values.push_back(
        value_text(scaled(campaign_.parameters[p], drawn_[round][p + (from_second ? dimensions : 0)])));
  }
  return run;
}

std::vector<std::uint64_t> RunPlan::looks() const {
  std::vector<std::uint64_t> looks;
  if (campaign_.stop)
    for (std::uint64_t at = campaign_.stop->first; at < rounds_; at *= 2) looks.push_back(at);
  looks.push_back(rounds_);
  return looks;
}

std::size_t RunPlan::groups() const {
  return campaign_.scenarios.size() * (campaign_.plan == SamplingPlan::grid ? grid_.size() : 1);
}

std::size_t RunPlan::group_of(const CampaignRun& run) const {
  return campaign_.plan == SamplingPlan::grid ? run.scenario * grid_.size() + run.point : run.scenario;
}

std::size_t RunPlan::world_of(const CampaignRun& run) const {
  return is_sensitivity(campaign_) ? run.point % points_a_round_ : 0;
}

bool RunPlan::counts(const CampaignRun& run) const { return world_of(run) < 2; }

}  // namespace understudy::studies

// A campaign: which scenarios are rehearsed on which built machines at which values of which parameters, and
// what is asked of the runs (docs/campaigns.md). Plain data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"

namespace understudy::studies {

/// How values of the parameters are chosen.
enum class SamplingPlan {
  grid,             ///< every combination of the values, each on every built machine
  latin_hypercube,  ///< a point for each built machine, spread evenly along each parameter
  sobol,            ///< a point for each built machine, of a Sobol sequence
  sensitivity,      ///< pairs of points with one parameter after the other exchanged, for Sobol indices
};
const char* to_string(SamplingPlan plan);
const std::vector<std::string>& sampling_plan_words();

enum class ParameterScale { linear, logarithmic };

/// One key that varies: "machine.gap.aim_mm", "scenario.turn_deg", "plan.layer".
struct CampaignParameter {
  std::string key;
  std::vector<std::string> values;  ///< of a grid, as they stand in the file; else empty
  double from = 0, to = 0;          ///< of the other plans, both reached at most
  ParameterScale scale = ParameterScale::linear;
  Place place;  ///< in the campaign file
};

/// When to stop before all seeds have run: the interval of P(GO) is as narrow as asked, in every group.
struct StopRule {
  double half_width = 0;    ///< of the interval
  std::uint64_t first = 0;  ///< machines before the first look; each further look is at twice as many
};

struct Campaign {
  std::filesystem::path file;
  std::string name, description;
  std::vector<std::string> scenarios;           ///< paths; may change values (core/yaml/changed_file.h)
  std::uint64_t seed_first = 1, seed_last = 1;  ///< of the built machines, both included
  SamplingPlan plan = SamplingPlan::grid;
  std::vector<CampaignParameter> parameters;
  std::vector<std::string> metrics;  ///< whose quantiles are asked for
  double level = 0.95;               ///< of all intervals
  std::optional<StopRule> stop;

  std::uint64_t seeds() const { return seed_last - seed_first + 1; }
};

}  // namespace understudy::studies

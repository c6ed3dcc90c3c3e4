#include "studies/campaign/campaign_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "core/file/read_file.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "regression/metrics.h"
#include "studies/campaign/run_plan.h"
#include "studies/campaign/sampling.h"

namespace understudy::studies {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kSeedLast = (std::uint64_t{1} << 63) - 1;  // an integer of SQLite has a sign
constexpr int kStepsMax = 100'000;
constexpr std::size_t kParametersMax = 100;  // each may have so many values; docs/limits.md

std::vector<std::string> read_scenarios(YamlMap& map, const fs::path& folder) {
  std::vector<std::string> scenarios;
  for (const std::string& word : map.texts("scenarios", "paths of scenario files, relative to this one")) {
    const ChangedFile changed = changed_file(word);
    const fs::path path = (folder / changed.file).lexically_normal();
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      map.fail("scenarios", fmt::format("scenario {} does not exist or is not a file", path.string()));
    scenarios.push_back(path.string() + changed.braces());
  }
  return scenarios;
}

void read_seeds(YamlMap& map, Campaign& campaign) {
  const std::string text = map.text("seeds", "of the built machines, a range like 1-200");
  if (text.empty()) return;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, campaign.seed_first);
  const bool dash = first.ec == std::errc() && first.ptr != end && *first.ptr == '-';
  const auto last = dash ? std::from_chars(first.ptr + 1, end, campaign.seed_last) : first;
  if (!dash || last.ec != std::errc() || last.ptr != end)
    map.fail("seeds", "'seeds' must be a range like 1-200, not '" + text + "'");
  if (campaign.seed_last < campaign.seed_first) map.fail("seeds", "seeds " + text + " run backwards");
  if (campaign.seed_last > kSeedLast)
    map.fail("seeds", fmt::format("seed {} is above {}", campaign.seed_last, kSeedLast));
}

/// from, to and steps of a grid as its values.
std::vector<std::string> steps_of(const CampaignParameter& parameter, int steps) {
  std::vector<std::string> values;
  for (int i = 0; i < steps; ++i)
    values.push_back(value_text(scaled(parameter, static_cast<double>(i) / (steps - 1))));
  return values;
}

void read_range(YamlMap& map, CampaignParameter& parameter) {
  parameter.from = map.number("from", {}, "smallest value");
  parameter.to = map.number("to", {}, "largest value");
  if (map.has("scale"))
    parameter.scale =
        map.word("scale", {"linear", "logarithmic"}, "along which values lie evenly") == "linear"
            ? ParameterScale::linear
            : ParameterScale::logarithmic;
  if (!map.complete()) return;
  if (parameter.from >= parameter.to)
    map.fail("to", fmt::format("{} runs from {:g} to {:g}: an empty range", parameter.key, parameter.from,
                               parameter.to));
  if (parameter.scale == ParameterScale::logarithmic && parameter.from <= 0)
    map.fail("from", fmt::format("{} begins at {:g}; a logarithmic scale needs values above 0", parameter.key,
                                 parameter.from));
}

CampaignParameter read_parameter(YamlMap& map, SamplingPlan plan) {
  CampaignParameter parameter;
  parameter.place = map.place();
  parameter.key = map.text("key", "what varies: machine.gap.aim_mm, scenario.turn_deg, plan.layer");
  const bool grid = map.either("grid", plan == SamplingPlan::grid);
  if (!grid && !map.recording())
    map.refuse("values", fmt::format("{}: 'values' are those of a grid; a plan {} needs 'from' and 'to'",
                                     parameter.key, to_string(plan)));
  if (grid && map.has("values")) {
    parameter.values = map.texts("values", "the values, in their order");
    return parameter;
  }
  read_range(map, parameter);
  if (!grid) return parameter;
  const int steps = map.integer("steps", 2, kStepsMax, "values from `from` to `to`, both included");
  if (map.complete()) parameter.values = steps_of(parameter, steps);
  return parameter;
}

void read_stop(YamlMap& map, const Campaign& campaign, StopRule& stop) {
  stop.half_width = map.number("half_width", {0.001, 0.5}, "of the interval of P(GO), in every group");
  stop.first = 16;
  if (map.has("first"))
    stop.first = static_cast<std::uint64_t>(
        map.integer("first", 2, 1'000'000, "machines before the first look; then twice as many each time"));
  if (map.complete() && stop.first > campaign.seeds())
    map.fail("first", fmt::format("the first look is after {} machines, and there are {}", stop.first,
                                  campaign.seeds()));
}

void check_metrics(YamlMap& map, const std::vector<std::string>& metrics) {
  for (const std::string& metric : metrics) {
    map.check_word("metrics", metric, regression::metric_names());
    if (regression::metric_is_text(metric) || regression::metric_is_of_the_run(metric) ||
        regression::metric_is_of_series(metric))
      map.fail("metrics", fmt::format("{} is no figure of the print: it has no quantiles", metric));
  }
}

void check_parameters(const Campaign& campaign) {
  std::set<std::string> keys;
  for (const CampaignParameter& parameter : campaign.parameters)
    if (!keys.insert(parameter.key).second)
      throw InputError(parameter.place, fmt::format("parameter {} is told twice", parameter.key));
}

void read_campaign(YamlMap& map, const fs::path& folder, Campaign& campaign) {
  campaign.name = map.text("name", "of the campaign, in its table");
  if (map.has("description")) campaign.description = map.text("description", "what it is to find out");
  campaign.scenarios = read_scenarios(map, folder);
  read_seeds(map, campaign);
  if (map.has("plan")) {
    const std::string word = map.word("plan", sampling_plan_words(), "how values are chosen; else grid");
    const auto& words = sampling_plan_words();
    campaign.plan = static_cast<SamplingPlan>(std::find(words.begin(), words.end(), word) - words.begin());
  }
  if (map.has("parameters"))
    map.list("parameters", 0, "what varies besides the built machine", [&](YamlMap& item, std::size_t i) {
      if (i == kParametersMax)
        throw InputError(item.place(), fmt::format("more than {} parameters", kParametersMax));
      campaign.parameters.push_back(read_parameter(item, campaign.plan));
    });
  if (map.has("metrics")) campaign.metrics = map.texts("metrics", "figures whose quantiles are asked for");
  check_metrics(map, campaign.metrics);
  if (map.has("level_percent"))
    campaign.level = map.quantity("level_percent", {50, 99.99}, "of all intervals; else 95");
  if (map.has("stop"))
    map.section("stop", "before all machines have run",
                [&](YamlMap& stop) { read_stop(stop, campaign, campaign.stop.emplace()); });
  if (!map.complete()) return;
  check_parameters(campaign);
  if (campaign.plan != SamplingPlan::grid && campaign.parameters.empty())
    map.fail("plan", fmt::format("a plan {} needs parameters", to_string(campaign.plan)));
  if (campaign.plan == SamplingPlan::sensitivity && campaign.stop)
    map.fail("stop", "Sobol indices need all pairs: no early stop with a plan sensitivity");
  if (campaign.plan == SamplingPlan::sensitivity && campaign.seeds() < 16)
    map.fail("seeds",
             fmt::format("Sobol indices need at least 16 machines, not {}: two a pair", campaign.seeds()));
  check_run_count(campaign);
}

}  // namespace

const std::vector<std::string>& sampling_plan_words() {
  static const std::vector<std::string> words{"grid", "latin-hypercube", "sobol", "sensitivity"};
  return words;
}

const char* to_string(SamplingPlan plan) {
  return sampling_plan_words()[static_cast<std::size_t>(plan)].c_str();
}

Campaign load_campaign(const fs::path& path) {
  Campaign campaign;
  campaign.file = path;
  YamlMap::read_text(read_file(path), path.string(),
                     [&](YamlMap& map) { read_campaign(map, path.parent_path(), campaign); });
  return campaign;
}

MapSchema campaign_schema() {
  return YamlMap::schema([](YamlMap& map) {
    Campaign campaign;
    read_campaign(map, {}, campaign);
  });
}

}  // namespace understudy::studies

// The folder of `understudy scenario run --out`: a folder of results for each scenario, `outcomes/` with
// their figures, `index.html`, and `history.jsonl` with the runs before.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "regression/scenario_outcome.h"

namespace understudy::cli {

/// Throws InputError, before any work, where two scenarios would write into one folder or something there is
/// not ours.
void check_scenario_folder(std::span<const regression::Scenario> scenarios,
                           const std::filesystem::path& folder);

std::filesystem::path outcome_file(const std::filesystem::path& folder, const regression::Scenario& scenario);

/// Outcomes of an earlier run, by the scenario's file name; throws InputError where `folder` holds none at
/// all.
std::map<std::string, regression::Metrics> load_baseline(std::span<const regression::Scenario> scenarios,
                                                         const std::filesystem::path& folder);

/// The outcome that lies in `folder`, where it was made from the same inputs and its report is there.
std::optional<regression::ScenarioOutcome> finished_outcome(const std::filesystem::path& folder,
                                                            const regression::Scenario& scenario,
                                                            const std::string& inputs);

struct RunScenario {
  regression::Scenario scenario;
  regression::ScenarioResult result;
  std::vector<regression::MetricChange> changes;  ///< from the baseline
  bool resumed = false;                           ///< a run before this one had finished it
  regression::Metrics metrics;
};

std::string replay_command(const regression::Scenario& scenario);

/// Writes index.html, and adds a line to history.jsonl.
void write_scenario_index(std::span<const RunScenario> runs, const std::filesystem::path& folder);

}  // namespace understudy::cli

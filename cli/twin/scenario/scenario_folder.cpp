#include "cli/twin/scenario/scenario_folder.h"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "report/page/scenario_index.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kOutcomes = "outcomes";
constexpr const char* kHistory = "history.jsonl";

std::string folder_of(const regression::Scenario& scenario) { return scenario.file.stem().string(); }

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

}  // namespace

void check_scenario_folder(std::span<const regression::Scenario> scenarios, const fs::path& folder) {
  std::map<std::string, fs::path> taken;
  for (const auto& scenario : scenarios) {
    const auto [other, is_new] = taken.emplace(folder_of(scenario), scenario.file);
    if (!is_new)
      throw InputError(fmt::format("{} and {} would write into one folder of --out: rename one",
                                   other->second.string(), scenario.file.string()));
    if (folder_of(scenario) == kOutcomes)
      throw InputError(scenario.file.string() + ": the folder '" + kOutcomes +
                       "' of --out is taken: rename it");
    check_replaceable(folder / folder_of(scenario));
  }
  const fs::path index = folder / "index.html";
  if (is_there(index) && read_file(index).find(report::kIndexMark) == std::string::npos)
    throw InputError(index.string() + " is no index of scenarios: move it away, or name another --out");
  if (is_there(folder / kHistory))
    report::read_history(read_file(folder / kHistory), (folder / kHistory).string());
}

fs::path outcome_file(const fs::path& folder, const regression::Scenario& scenario) {
  return folder / kOutcomes / (folder_of(scenario) + ".yaml");
}

std::map<std::string, regression::Metrics> load_baseline(std::span<const regression::Scenario> scenarios,
                                                         const fs::path& folder) {
  std::map<std::string, regression::Metrics> baseline;
  for (const auto& scenario : scenarios)
    if (const fs::path file = outcome_file(folder, scenario); is_there(file))
      baseline[folder_of(scenario)] = regression::load_outcome(file).outcome.run;
  if (baseline.empty())
    throw InputError(
        fmt::format("--baseline {}: none of these scenarios has a result there; it is the folder of an "
                    "earlier --out",
                    folder.string()));
  return baseline;
}

std::optional<regression::ScenarioOutcome> finished_outcome(const fs::path& folder,
                                                            const regression::Scenario& scenario,
                                                            const std::string& inputs) {
  const fs::path file = outcome_file(folder, scenario);
  if (inputs.empty() || !is_there(file)) return std::nullopt;
  auto recorded = regression::load_outcome(file);
  const std::uint64_t machines = scenario.machines ? scenario.machines->count() : 0;
  if (recorded.inputs != inputs || recorded.outcome.machines.size() != machines) return std::nullopt;
  return std::move(recorded.outcome);
}

std::string replay_command(const regression::Scenario& scenario) {
  return fmt::format("understudy scenario run {} --out {}", shell_quoted(scenario.file.string()),
                     shell_quoted(folder_of(scenario) + "-out"));
}

void write_scenario_index(std::span<const RunScenario> runs, const fs::path& folder) {
  const fs::path history = folder / kHistory;
  const std::string past = is_there(history) ? read_file(history) : "";
  std::vector<report::IndexedScenario> indexed;
  std::vector<regression::ScenarioResult> results;
  for (const RunScenario& run : runs) {
    const std::string name = folder_of(run.scenario);
    const std::string picture = name + "/pictures/picture-01.png";
    indexed.push_back({run.result, run.scenario.description,
                       is_there(folder / name / "report.html") ? name : "",
                       is_there(folder / picture) ? picture : "", replay_command(run.scenario), run.changes});
    results.push_back(run.result);
  }
  fs::create_directories(folder);
  write_file(folder / "index.html",
             report::scenario_index_html(indexed, report::read_history(past, history.string())));
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const std::size_t whole = past.rfind('\n') + 1;  // a line that was cut off goes
  write_file(history,
             past.substr(0, whole) +
                 report::history_line(fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)), results));
}

}  // namespace understudy::cli

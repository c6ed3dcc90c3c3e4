#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/jobs_option.h"
#include "cli/progress.h"
#include "cli/twin/planned_program.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "regression/junit.h"
#include "regression/run_scenario.h"
#include "regression/scenario_file.h"
#include "report/page/write_results.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;

struct ScenarioRequest {
  std::vector<std::string> paths;
  std::string junit, folder;
  int threads = 0;
};

/// The folder of shipped scenarios, when none is named: here, or beside the models.
std::vector<fs::path> scenario_files(const std::vector<std::string>& named) {
  std::vector<fs::path> paths(named.begin(), named.end());
  if (paths.empty())
    paths.push_back(fs::is_directory("scenarios") ? fs::path("scenarios")
                                                  : machine::models_folder().parent_path() / "scenarios");
  return regression::find_scenarios(paths);
}

void print_result(const regression::ScenarioResult& result) {
  fmt::print("{} {}\n", result.passed() ? "pass" : "FAIL", result.name);
  if (!result.error.empty()) fmt::print("     error: {}\n", result.error);
  for (const auto& check : result.checks)
    fmt::print("     {} {}\n", check.ok ? "ok  " : "FAIL", check.ok ? check.name : check.message);
}

/// With the program that a plan has made: nobody else has it.
regression::RecordSink results_in(const fs::path& folder, const std::string& planned) {
  return [folder, &planned](const rehearsal::Record& record) {
    OutputFolder out(folder);
    report::write_results(record, report::draw_scene(*record.scene), out.path());
    if (!planned.empty()) write_file(out.path() / regression::kPlannedProgram, planned);
    out.commit();
  };
}

/// A failure names a scenario by its name.
void check_names(const std::vector<regression::Scenario>& scenarios) {
  std::map<std::string, fs::path> taken;
  for (const auto& scenario : scenarios) {
    const auto [other, is_new] = taken.emplace(scenario.name, scenario.file);
    if (!is_new)
      throw InputError(fmt::format("{} and {} are both named '{}': rename one", other->second.string(),
                                   scenario.file.string(), scenario.name));
  }
}

/// Each has a folder of its file's name, whose older result may be replaced.
void check_folders(const std::vector<regression::Scenario>& scenarios, const fs::path& folder) {
  std::map<std::string, fs::path> taken;
  for (const auto& scenario : scenarios) {
    const auto [other, is_new] = taken.emplace(scenario.file.stem().string(), scenario.file);
    if (!is_new)
      throw InputError(fmt::format("{} and {} would write into one folder of --out: rename one",
                                   other->second.string(), scenario.file.string()));
    check_replaceable(folder / scenario.file.stem());
  }
}

int run(const ScenarioRequest& request) {
  check_jobs(request.threads);
  std::vector<regression::Scenario> scenarios;  // all are read before the first runs: a typo costs no time
  for (const auto& file : scenario_files(request.paths)) scenarios.push_back(regression::load_scenario(file));
  if (!request.folder.empty()) check_folders(scenarios, request.folder);
  check_names(scenarios);
  if (!request.junit.empty()) check_writable(request.junit);
  std::vector<regression::ScenarioResult> results;
  int failed = 0;
  for (const auto& scenario : scenarios) {
    const auto begin = std::chrono::steady_clock::now();
    regression::ScenarioResult result;
    {
      ProgressLine line;
      regression::ScenarioRun how{request.threads, {}, {}, {}};
      how.progress = [&](double share, const std::string& what) {
        line.show(share, scenario.name + ": " + what);
      };
      std::string planned;
      how.plan = [&](const regression::Scenario& each, const fs::path& output) {
        write_planned(each, output);
        planned = read_file(output);
      };
      if (!request.folder.empty())
        how.sink = results_in(fs::path(request.folder) / scenario.file.stem(), planned);
      result = regression::run_scenario(scenario, how);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    print_result(result);
    failed += !result.passed();
    results.push_back(std::move(result));
  }
  if (!request.junit.empty()) write_file(request.junit, regression::junit_xml(results));
  fmt::print("{} passed, {} failed\n", results.size() - static_cast<std::size_t>(failed), failed);
  for (const int status : {kBadInput, kFailed})
    if (std::ranges::count(results, status, &regression::ScenarioResult::error_status) > 0) return status;
  return failed == 0 ? kGood : kNo;
}

int list(const ScenarioRequest& request) {
  for (const auto& file : scenario_files(request.paths)) {
    const auto scenario = regression::load_scenario(file);
    fmt::print("{:<32} {} [{}, {} expectations]\n", file.string(), scenario.name, scenario.machine,
               scenario.expect.size() + (scenario.machines ? scenario.machines->expect.size() : 0));
  }
  return kGood;
}

}  // namespace

void add_scenario(CLI::App& app, Action& action) {
  auto request = std::make_shared<ScenarioRequest>();
  auto* command = app.add_subcommand("scenario", "Rehearsals with what is expected of them, for CI");
  command->require_subcommand(1);
  auto* run_command = command->add_subcommand(
      "run", "Run scenarios: status 0 when every expectation holds, 1 when one does not");
  run_command->add_option("paths", request->paths, "scenario files or folders (default: scenarios/)");
  add_jobs(*run_command, request->threads, "threads for series of machines; results do not depend on it");
  run_command->add_option("--junit", request->junit, "also write JUnit XML to this file");
  run_command->add_option("--out", request->folder, "also write each rehearsal's report below this folder");
  run_command->callback([=, &action] { action = [=] { return run(*request); }; });
  auto* list_command = command->add_subcommand("list", "List scenarios");
  list_command->add_option("paths", request->paths, "scenario files or folders (default: scenarios/)");
  list_command->callback([=, &action] { action = [=] { return list(*request); }; });
}

}  // namespace understudy::cli

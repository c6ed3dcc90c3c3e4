#include "cli/twin/scenario/scenario_runs.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/progress.h"
#include "cli/twin/command_figures.h"
#include "cli/twin/own_process.h"
#include "cli/twin/planned_program.h"
#include "cli/twin/scenario/scenario_folder.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/file/scratch_folder.h"
#include "core/parallel.h"
#include "regression/golden_file.h"
#include "regression/junit.h"
#include "regression/run_scenario.h"
#include "regression/scenario_file.h"
#include "report/page/write_results.h"
#include "report/scenario_results_json.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;
using regression::Scenario;
using regression::ScenarioOutcome;

/// With the program that a plan has made: nobody else has it.
regression::RecordSink results_in(const fs::path& folder, bool pictures, const std::string& planned) {
  return [folder, pictures, &planned](const rehearsal::Record& record) {
    OutputFolder out(folder);
    report::write_results(record, pictures ? report::pictures_of(record) : report::DrawPictures(),
                          out.path());
    if (!planned.empty()) write_file(out.path() / regression::kPlannedProgram, planned);
    out.commit();
  };
}

/// `folder` may be empty: nobody else sees then what the command writes.
regression::Metrics figures_in(const Scenario& scenario, const fs::path& folder) {
  std::optional<ScratchFolder> scratch;
  if (folder.empty()) scratch.emplace("command");
  return command_figures(scenario,
                         folder.empty() ? scratch->path() / "results" : folder / scenario.file.stem());
}

/// In this process. Without a folder in the request no report is written.
ScenarioOutcome run_here(const Scenario& scenario, const ScenarioRequest& request, const Progress& progress) {
  const fs::path folder = request.folder;
  regression::ScenarioRun how{request.threads, {}, progress, {}, {}};
  how.command = [&](const Scenario& each) { return figures_in(each, folder); };
  std::string planned;
  how.plan = [&](const Scenario& each, const fs::path& output) {
    write_planned(each, output);
    planned = read_file(output);
  };
  if (!folder.empty()) how.sink = results_in(folder / scenario.file.stem(), request.pictures, planned);
  return regression::run_scenario(scenario, how);
}

ScenarioOutcome run_in_process(const Scenario& scenario, const fs::path& outcome,
                               const ScenarioRequest& request) {
  std::vector<std::string> words{"scenario",
                                 "outcome",
                                 scenario.file.string(),
                                 "--outcome",
                                 outcome.string(),
                                 "-j",
                                 std::to_string(std::max(1, request.threads / request.processes))};
  if (!request.folder.empty()) words.insert(words.end(), {"--out", request.folder});
  if (!request.pictures) words.emplace_back("--no-pictures");
  std::error_code ignored;
  fs::remove(outcome, ignored);
  if (const ProcessEnd end = run_own_process(words); end.status != kGood) {
    ScenarioOutcome lost;
    lost.error = end.text;
    lost.error_status = kFailed;
    return lost;
  }
  return regression::load_outcome(outcome).outcome;
}

/// A failure names a scenario by its name.
void check_names(const std::vector<Scenario>& scenarios) {
  std::map<std::string, fs::path> taken;
  for (const auto& scenario : scenarios) {
    const auto [other, is_new] = taken.emplace(scenario.name, scenario.file);
    if (!is_new)
      throw InputError(fmt::format("{} and {} are both named '{}': rename one", other->second.string(),
                                   scenario.file.string(), scenario.name));
  }
}

void check_options(const ScenarioRequest& request) {
  check_jobs(request.threads);
  if (request.processes < 1 || request.processes > 1024)
    throw InputError(fmt::format("--processes {} is outside 1..1024", request.processes));
  if (request.resume && request.folder.empty())
    throw InputError("--resume needs --out: the folder that a run which was stopped wrote into");
}

void print_run(const RunScenario& run) {
  const auto& result = run.result;
  fmt::print("{} {}\n", result.passed() ? "pass" : "FAIL", result.name);
  if (!result.error.empty()) fmt::print("     error: {}\n", result.error);
  for (const auto& check : result.checks)
    fmt::print("     {} {}\n", check.ok ? "ok  " : "FAIL", check.ok ? check.name : check.message);
  fmt::print("     time {:.1f} s{}\n", result.seconds.value_or(0), run.resumed ? ", done before" : "");
  for (const auto& change : run.changes) fmt::print("     diff {}\n", regression::text_of(change));
  if (!result.passed()) fmt::print("     alone: {}\n", replay_command(run.scenario));
  std::fflush(stdout);
}

/// Runs what has to run, and prints each result when those before it are printed.
class Runner {
 public:
  Runner(const ScenarioRequest& request, std::vector<Scenario> scenarios)
      : request_(request), scenarios_(std::move(scenarios)), runs_(scenarios_.size()) {
    if (!request.baseline.empty()) baseline_ = load_baseline(scenarios_, request.baseline);
    if (request.folder.empty()) scratch_.emplace("scenarios");
    outcomes_ = request.folder.empty() ? scratch_->path() : fs::path(request.folder);
    fs::create_directories(outcome_file(outcomes_, scenarios_.front()).parent_path());
  }

  const std::vector<RunScenario>& run() {
    runs_done_.assign(scenarios_.size(), false);
    const auto count = static_cast<double>(scenarios_.size());
    // One at a time tells of itself.
    ProgressLine line(!request_.output.quiet && request_.processes > 1, {"scenarios", count});
    line_ = &line;
    line.show(0, fmt::format("scenario 0 of {}", scenarios_.size()));
    in_parallel(scenarios_.size(), request_.processes, [this](std::size_t i) { run_one(i); });
    return runs_;
  }

 private:
  void run_one(std::size_t i) {
    const Scenario& scenario = scenarios_[i];
    const std::string inputs = regression::outcome_inputs(scenario, sources_sha256(scenario));
    std::optional<ScenarioOutcome> outcome;
    if (request_.resume) outcome = finished_outcome(outcomes_, scenario, inputs);
    const bool resumed = outcome.has_value();
    if (!resumed) outcome = request_.processes > 1 ? in_process(scenario) : here(scenario, inputs);
    finish(i, *outcome, resumed);
  }

  ScenarioOutcome in_process(const Scenario& scenario) {
    return run_in_process(scenario, outcome_file(outcomes_, scenario), request_);
  }

  ScenarioOutcome here(const Scenario& scenario, const std::string& inputs) {
    ProgressLine line(!request_.output.quiet);
    ScenarioOutcome outcome = run_here(scenario, request_, [&](double share, const std::string& what) {
      line.show(share, scenario.name + ": " + what);
    });
    write_file(outcome_file(outcomes_, scenario), regression::outcome_text(scenario, outcome, inputs));
    return outcome;
  }

  void finish(std::size_t i, const ScenarioOutcome& outcome, bool resumed) {
    const std::scoped_lock lock(mutex_);
    const Scenario& scenario = scenarios_[i];
    runs_[i] = {scenario, regression::judge(scenario, outcome), {}, resumed, outcome.run};
    const fs::path report = fs::path(request_.folder) / scenario.file.stem() / "report.html";
    if (!request_.folder.empty() && fs::exists(report)) runs_[i].result.report = report.string();
    if (const auto before = baseline_.find(scenario.file.stem().string()); before != baseline_.end())
      runs_[i].changes = regression::changes(before->second, outcome.run);
    runs_done_[i] = true;
    line_->clear();
    for (; printed_ < runs_.size() && runs_done_[printed_]; ++printed_) tell(runs_[printed_]);
    const auto done = std::ranges::count(runs_done_, true);
    line_->show(static_cast<double>(done) / static_cast<double>(runs_.size()),
                fmt::format("scenario {} of {}", done, runs_.size()));
  }

  void tell(const RunScenario& run) const {
    if (!request_.output.json && !(request_.output.quiet && run.result.passed())) print_run(run);
  }

  const ScenarioRequest& request_;
  std::vector<Scenario> scenarios_;
  std::vector<RunScenario> runs_;
  std::vector<bool> runs_done_;
  std::map<std::string, regression::Metrics> baseline_;
  std::optional<ScratchFolder> scratch_;
  fs::path outcomes_;
  std::size_t printed_ = 0;
  ProgressLine* line_ = nullptr;  ///< of run()
  std::mutex mutex_;
};

/// Of scenarios that hold what else they expect: a figure that is wrong shall not become golden.
void update_golden(const std::vector<RunScenario>& runs, std::FILE* told) {
  for (const RunScenario& run : runs) {
    const fs::path golden = regression::golden_file_of(run.scenario.file);
    const auto& checks = run.result.checks;
    const bool holds = run.result.error.empty() &&
                       std::all_of(checks.begin(), checks.end() - std::ssize(run.scenario.golden),
                                   [](const regression::Check& check) { return check.ok; });
    if (!holds) {
      fmt::print(stderr, "understudy: {} fails: {} is not written\n", run.scenario.name, golden.string());
      continue;
    }
    fs::create_directories(golden.parent_path());
    write_file(golden, regression::golden_text(run.scenario, run.metrics, run.scenario.golden));
    fmt::print(told, "{}\n", golden.string());
  }
}

void print_end(const ScenarioRequest& request, const std::vector<RunScenario>& runs) {
  if (request.output.json) {
    std::vector<report::ToldScenario> told;
    for (const RunScenario& run : runs) told.push_back({run.result, run.changes});
    fmt::print("{}", report::scenario_results_json(told));
    return;
  }
  const auto passed = std::ranges::count_if(runs, [](const RunScenario& run) { return run.result.passed(); });
  fmt::print("{} passed, {} failed\n", passed, std::ssize(runs) - passed);
  if (!request.folder.empty() && !request.output.quiet)
    fmt::print("index: {}\n", (fs::path(request.folder) / "index.html").string());
}

int exit_status_of(const std::vector<RunScenario>& runs) {
  for (const int status : {kBadInput, kFailed})
    for (const RunScenario& run : runs)
      if (run.result.error_status == status) return status;
  return std::ranges::all_of(runs, [](const RunScenario& run) { return run.result.passed(); }) ? kGood : kNo;
}

}  // namespace

std::vector<fs::path> scenario_files(const std::vector<std::string>& named) {
  std::vector<fs::path> paths(named.begin(), named.end());
  if (paths.empty())
    paths.push_back(fs::is_directory("scenarios") ? fs::path("scenarios")
                                                  : machine::models_folder().parent_path() / "scenarios");
  return regression::find_scenarios(paths);
}

int run_scenarios(const ScenarioRequest& request) {
  check_options(request);
  std::vector<Scenario> scenarios;  // all are read before the first runs: a typo costs no time
  for (const auto& file : scenario_files(request.paths)) scenarios.push_back(regression::load_scenario(file));
  if (!request.folder.empty()) check_scenario_folder(scenarios, request.folder);
  check_names(scenarios);
  if (!request.junit.empty()) check_writable(request.junit);
  Runner runner(request, std::move(scenarios));
  const std::vector<RunScenario>& runs = runner.run();
  std::vector<regression::ScenarioResult> results;
  for (const RunScenario& run : runs) results.push_back(run.result);
  if (!request.junit.empty()) write_file(request.junit, regression::junit_xml(results));
  if (!request.folder.empty()) write_scenario_index(runs, request.folder);
  print_end(request, runs);
  if (request.update_golden) update_golden(runs, request.output.json ? stderr : stdout);
  return exit_status_of(runs);
}

int run_for_outcome(const ScenarioRequest& request, const fs::path& outcome) {
  end_with_parent();
  const Scenario scenario = regression::load_scenario(request.paths.at(0));
  const std::string inputs = regression::outcome_inputs(scenario, sources_sha256(scenario));
  write_file(outcome, regression::outcome_text(scenario, run_here(scenario, request, {}), inputs));
  return kGood;
}

}  // namespace understudy::cli

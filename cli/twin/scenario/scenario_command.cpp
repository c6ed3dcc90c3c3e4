#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/twin/scenario/scenario_runs.h"
#include "regression/scenario_file.h"

namespace understudy::cli {
namespace {

int list(const ScenarioRequest& request) {
  for (const auto& file : scenario_files(request.paths)) {
    const auto scenario = regression::load_scenario(file);
    fmt::print("{:<32} {} [{}, {} expectations]\n", file.string(), scenario.name,
               scenario.command.empty() ? scenario.machine : "command",
               scenario.expect.size() + (scenario.machines ? scenario.machines->expect.size() : 0));
  }
  return kGood;
}

void add_no_pictures(CLI::App& command, const std::shared_ptr<ScenarioRequest>& request) {
  command
      .add_flag(
          "!--no-pictures", request->pictures,
          "leave the drawings of machine and part out of the reports, which take most of a short run's time")
      ->needs("--out");
}

void add_run(CLI::App& command, const std::shared_ptr<ScenarioRequest>& request, Action& action) {
  auto* run = command.add_subcommand(
      "run", "Run scenarios: status 0 when every expectation holds, 1 when one does not");
  run->add_option("paths", request->paths, "scenario files or folders (default: scenarios/)");
  add_jobs(*run, request->threads, "threads for series of machines; results do not depend on it");
  run->add_option("--processes", request->processes, "scenarios at a time, each in a process of its own")
      ->capture_default_str();
  run->add_option("--junit", request->junit, "also write JUnit XML to this file");
  run->add_option("--out", request->folder,
                  "also write each rehearsal's report below this folder, and an index page");
  add_no_pictures(*run, request);
  run->add_flag("--resume", request->resume,
                "take what a stopped run finished from --out where its inputs are the same");
  run->add_option("--baseline", request->baseline,
                  "show which figures differ from those in this earlier --out");
  run->add_flag("--update-golden", request->update_golden,
                "write the figures of scenarios that pass to golden/ beside them");
  add_quiet_option(*run, request->output, "no progress, and only the scenarios that fail and how many");
  add_json_option(*run, request->output, "the results of all scenarios");
  run->callback([=, &action] { action = [=] { return run_scenarios(*request); }; });
}

/// For `run --processes` alone.
void add_outcome(CLI::App& command, const std::shared_ptr<ScenarioRequest>& request, Action& action) {
  auto* one = command.add_subcommand("outcome", "Run one scenario for another process")->group("");
  auto outcome = std::make_shared<std::string>();
  one->add_option("paths", request->paths)->required()->expected(1);
  one->add_option("--outcome", *outcome)->required();
  one->add_option("--out", request->folder);
  add_no_pictures(*one, request);
  add_jobs(*one, request->threads);
  one->callback([=, &action] { action = [=] { return run_for_outcome(*request, *outcome); }; });
}

}  // namespace

void add_scenario(CLI::App& app, Action& action) {
  auto request = std::make_shared<ScenarioRequest>();
  auto* command = app.add_subcommand("scenario", "Rehearsals with what is expected of them, for CI");
  command->require_subcommand(1);
  add_run(*command, request, action);
  add_outcome(*command, request, action);
  auto* list_command = command->add_subcommand("list", "List scenarios");
  list_command->add_option("paths", request->paths, "scenario files or folders (default: scenarios/)");
  list_command->callback([=, &action] { action = [=] { return list(*request); }; });
}

}  // namespace understudy::cli

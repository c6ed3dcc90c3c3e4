#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "cli/twin/planned_program.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/scratch_folder.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "machine/description.h"
#include "regression/run_scenario.h"
#include "regression/scenario_file.h"
#include "regression/sweep.h"
#include "report/page/error_budget_page.h"
#include "report/study/error_budget_report.h"
#include "report/study/sweep_json.h"
#include "studies/budget/error_budget.h"

namespace understudy::cli {
namespace {

constexpr int kSweepSamples = 200, kBudgetSamples = 64;

struct SweepRequest {
  std::string scenario, as_built, folder = "sweep";
  bool budget = false;
  std::optional<int> samples;
  int threads = 0;
  std::uint64_t first_seed = 1;
  OutputOptions told;
};

/// Beside the folder of results, which appears when it is whole.
std::string journal_of(const SweepRequest& r) {
  const auto folder = std::filesystem::path(r.folder).lexically_normal();
  std::string journal = (folder.has_filename() ? folder : folder.parent_path()).string() + ".journal";
  if (std::filesystem::exists(journal))
    fmt::print(stderr, "goes on with {}; delete it to begin anew\n", journal);
  return journal;
}

/// `scratch`: where the program of a plan lies until all machines have printed it; made for a plan only.
rehearsal::RehearsalRequest print_of(const SweepRequest& r, std::optional<ScratchFolder>& scratch) {
  regression::Scenario scenario = regression::load_scenario(r.scenario);
  if (!scenario.command.empty())
    throw InputError(scenario.file.string() +
                     ": has a command, which is not printed: name a scenario with a program");
  if (!scenario.plan.empty()) {
    scenario.program = scratch.emplace("plan").path() / regression::kPlannedProgram;
    write_planned(scenario, scenario.program);
  }
  auto print = regression::request_of(scenario);
  if (!r.as_built.empty()) print.as_built = r.as_built;
  print.command = command_line();
  return print;
}

int run_budget(const SweepRequest& r) {
  studies::BudgetRequest request;
  request.samples = r.samples.value_or(kBudgetSamples);
  request.first_seed = r.first_seed;
  request.threads = r.threads;
  check_jobs(r.threads);
  std::optional<ScratchFolder> scratch;
  request.print = print_of(r, scratch);
  const studies::BudgetPlan plan = studies::plan_budget(request);
  if (!r.told.quiet) fmt::print(stderr, "{}\n", report::budget_cost(plan, request.samples));
  OutputFolder out(r.folder);
  request.journal = journal_of(r);
  studies::ErrorBudget budget;
  {
    ProgressLine line(!r.told.quiet, {"rehearsals", static_cast<double>(plan.rehearsals)});
    budget = studies::run_budget(request, line.teller());
  }
  const std::string json = report::budget_json(budget);
  write_file(out.path() / "budget.json", json);
  write_file(out.path() / "budget.csv", report::budget_csv(budget));
  write_file(out.path() / "runs.csv", report::budget_runs_csv(budget));
  write_file(out.path() / "budget.html", report::error_budget_html(budget));
  stop_if_interrupted();
  out.commit();
  const std::filesystem::path written(r.folder);
  const std::string files =
      fmt::format("{}\n{}\n", (written / "budget.json").string(), (written / "budget.html").string());
  print_answer(r.told, {report::budget_table(budget) + "\n" + files, files, json});
  return kGood;
}

int run_sweep(const SweepRequest& r) {
  const int samples = r.samples.value_or(kSweepSamples);
  if (samples < 1 || samples > 1000000)
    throw InputError(fmt::format("--samples {} is outside 1..1000000", samples));
  check_jobs(r.threads);
  std::optional<ScratchFolder> scratch;
  const auto request = print_of(r, scratch);
  const auto machine = machine::load_machine(request.machine);
  OutputFolder out(r.folder);
  const std::string journal = journal_of(r);
  std::vector<regression::SweepRow> rows;
  {
    ProgressLine line(!r.told.quiet, {"machines", static_cast<double>(samples)});
    rows = regression::sweep(request, r.first_seed, samples, r.threads, line.teller(), journal);
  }
  const double low_mm = to_mm(machine.gap.accepted_min), high_mm = to_mm(machine.gap.accepted_max);
  const std::string table = regression::sweep_table(rows, low_mm, high_mm);
  const std::string json = report::sweep_json(rows, low_mm, high_mm);
  write_file(out.path() / "sweep.json", json);
  write_file(out.path() / "sweep.csv", regression::sweep_csv(rows));
  write_file(out.path() / "table.txt", table);
  stop_if_interrupted();
  out.commit();
  const std::string file = (std::filesystem::path(r.folder) / "sweep.csv").string() + "\n";
  print_answer(r.told, {table + file, regression::sweep_verdict(rows), json});
  return kGood;
}

}  // namespace

void add_sweep(CLI::App& app, Action& action) {
  auto request = std::make_shared<SweepRequest>();
  auto* command =
      app.add_subcommand("sweep", "One scenario on many as-built machines, with and without gap control");
  command->add_option("scenario", request->scenario, "scenario file")->required();
  command->add_flag("--budget", request->budget,
                    "which truths the errors come from: Sobol indices (docs/error-budget.md)");
  command->add_option(
      "--samples", request->samples,
      fmt::format("machines, {} unless given; of a budget pairs of them, {}", kSweepSamples, kBudgetSamples));
  command->add_option("--as-built", request->as_built,
                      "sampled, manufactured or calibrated, in place of the scenario's");
  command->add_option("--first-seed", request->first_seed, "seed of the first machine")
      ->check(seed_check())
      ->capture_default_str();
  add_jobs(*command, request->threads);
  add_output_options(*command, request->told,
                     "the verdict alone, in one line; of a budget the names of the files",
                     "sweep.json, or budget.json,");
  command->add_option("--out", request->folder, "folder of results")->capture_default_str();
  command->callback([=, &action] {
    action = [=] { return request->budget ? run_budget(*request) : run_sweep(*request); };
  });
}

}  // namespace understudy::cli

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/jobs_option.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/output_file.h"
#include "core/units.h"
#include "machine/description.h"
#include "regression/run_scenario.h"
#include "regression/scenario_file.h"
#include "regression/sweep.h"

namespace understudy::cli {
namespace {

struct SweepRequest {
  std::string scenario, folder = "sweep";
  int samples = 200;
  int threads = 0;
  std::uint64_t first_seed = 1;
};

int run_sweep(const SweepRequest& r) {
  if (r.samples < 1 || r.samples > 1000000)
    throw InputError(fmt::format("--samples {} is outside 1..1000000", r.samples));
  check_jobs(r.threads);
  auto request = regression::request_of(regression::load_scenario(r.scenario));
  request.command = command_line();
  const auto machine = machine::load_machine(request.machine);
  OutputFolder out(r.folder, "sweep.csv");
  std::vector<regression::SweepRow> rows;
  {
    ProgressLine line;
    rows = regression::sweep(request, r.first_seed, r.samples, r.threads,
                             [&](double share, const std::string& what) { line.show(share, what); });
  }
  const auto table =
      regression::sweep_table(rows, to_mm(machine.gap.accepted_min), to_mm(machine.gap.accepted_max));
  write_file(out.path() / "sweep.csv", regression::sweep_csv(rows));
  write_file(out.path() / "table.txt", table);
  stop_if_interrupted();
  out.commit();
  fmt::print("{}{}\n", table, (std::filesystem::path(r.folder) / "sweep.csv").string());
  return kGood;
}

}  // namespace

void add_sweep(CLI::App& app, Action& action) {
  auto request = std::make_shared<SweepRequest>();
  auto* command =
      app.add_subcommand("sweep", "One scenario on many as-built machines, with and without gap control");
  command->add_option("scenario", request->scenario, "scenario file")->required();
  command->add_option("--samples", request->samples, "machines")->capture_default_str();
  command->add_option("--first-seed", request->first_seed, "seed of the first machine")
      ->capture_default_str();
  add_jobs(*command, request->threads);
  command->add_option("--out", request->folder, "folder of results")->capture_default_str();
  command->callback([=, &action] { action = [=] { return run_sweep(*request); }; });
}

}  // namespace understudy::cli

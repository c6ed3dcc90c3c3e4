#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "machine/description.h"
#include "report/page/gap_benchmark_page.h"
#include "studies/gap/gap_benchmark.h"

namespace understudy::cli {
namespace {

struct GapCall {
  studies::GapBenchmarkRequest request;
  std::string folder = "out/gap-benchmark";
  std::vector<std::string> plants{"quasistatic"};
  OutputOptions told;
};

int run_gap(const GapCall& call) {
  studies::GapBenchmarkRequest request = call.request;
  check_jobs(request.threads);
  request.plants.clear();
  for (const std::string& words : call.plants) request.plants.push_back(studies::plant_choice(words));
  request.command = command_line();
  if (request.program.empty())
    request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  OutputFolder out(call.folder);
  studies::GapBenchmark benchmark;
  {
    ProgressLine line(!call.told.quiet);
    benchmark = studies::run_gap_benchmark(request, line.teller());
  }
  const std::string json = report::gap_benchmark_json(benchmark);
  write_file(out.path() / "gap.json", json);
  write_file(out.path() / "gap.html", report::gap_benchmark_html(benchmark));
  stop_if_interrupted();
  out.commit();
  const std::filesystem::path written(call.folder);
  const std::string files =
      fmt::format("{}\n{}\n", (written / "gap.json").string(), (written / "gap.html").string());
  print_answer(call.told, {report::gap_benchmark_table(benchmark) + "\n" + files, files, json});
  return benchmark.good() ? kGood : kNo;
}

}  // namespace

void add_benchmark_gap(CLI::App& benchmark, Action& action) {
  auto call = std::make_shared<GapCall>();
  auto& request = call->request;
  auto* command = benchmark.add_subcommand(
      "gap", "How well the gap is measured, closed and followed over surfaces, light and faults");
  add_machine_option(*command, request.machine);
  command
      ->add_option("--part", request.parts,
                   "detectors, approach, following, bottle: these unless given; "
                   "faulted-approaches, faulted-prints")
      ->delimiter(',');
  command
      ->add_option("--trials", request.trials,
                   "approaches and followed beads for each surface and condition; ten times the frames; "
                   "faulted approaches, and faulted prints, in all")
      ->capture_default_str();
  command
      ->add_option("--machines", request.machines,
                   "as-built machines that print the bottle's line; built and calibrated ones "
                   "of faulted approaches and prints")
      ->capture_default_str();
  command
      ->add_option("--plant", call->plants,
                   "ENGINE or ENGINE:STEP_MS of faulted approaches and prints; each trial runs on all, and "
                   "answers are compared with the first")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--fault", request.faults, "of faulted approaches and prints; else all take turns")
      ->delimiter(',');
  command->add_option("--seed", request.seed, "of the machines and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("--program", request.program, "of the bottle's line; else scenarios/song-bottle.gcode");
  add_jobs(*command, request.threads);
  add_output_options(*command, call->told, "the names of the files alone", "gap.json");
  command->add_option("--out", call->folder, "folder of results")->capture_default_str();
  command->footer(
      "Writes gap.json and gap.html (docs/gap-control.md). Exit status 1: a faulted trial touched, or was "
      "answered wrongly.\n"
      "Example: understudy benchmark gap --part faulted-approaches --trials 200 --plant "
      "quasistatic,mujoco:0.5");
  command->callback([=, &action] { action = [=] { return run_gap(*call); }; });
}

}  // namespace understudy::cli

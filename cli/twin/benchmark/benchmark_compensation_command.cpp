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
#include "cli/twin/compensation_commands.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "report/study/compensation_report.h"
#include "studies/compensation/compensated_prints.h"

namespace understudy::cli {
namespace {

struct CompensationCall {
  studies::CompensationStudyRequest request;
  std::string folder = "out/compensation";
  OutputOptions told;
};

int run_study(const CompensationCall& call) {
  studies::CompensationStudyRequest request = call.request;
  check_jobs(request.threads);
  request.command = command_line();
  OutputFolder out(call.folder);
  studies::CompensationStudy study;
  {
    ProgressLine line(!call.told.quiet, {"machines", static_cast<double>(request.machines)});
    study = studies::run_compensation_study(request, line.teller());
  }
  const std::string json = report::compensation_json(study);
  write_file(out.path() / "compensation.json", json);
  stop_if_interrupted();
  out.commit();
  const std::string file = (std::filesystem::path(call.folder) / "compensation.json").string() + "\n";
  print_answer(call.told, {report::compensation_table(study) + file, file, json});
  return kGood;
}

}  // namespace

void add_benchmark_compensation(CLI::App& benchmark, Action& action) {
  auto call = std::make_shared<CompensationCall>();
  auto& request = call->request;
  auto* command = benchmark.add_subcommand(
      "compensation", "Built machines that print a compensated program with a nominal controller");
  add_machine_option(*command, request.machine);
  command->add_option("--machines", request.machines, "built machines")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--seed", request.first_seed, "of the first built machine; the next ones follow")
      ->check(seed_check())
      ->capture_default_str();
  command->add_flag("--driven", request.driven,
                    "calibrate from poses that were measured on the machine with its play in place");
  command
      ->add_option("--estimator", request.estimator,
                   "of the geometry, as of `calibrate`; with_play finds a hexapod's plays, with --driven")
      ->capture_default_str();
  command->add_option("--poses", request.poses, "measured of each machine")
      ->check(CLI::Range(3, 10000))
      ->capture_default_str();
  add_jobs(*command, request.threads);
  add_output_options(*command, call->told, "the name of the file alone", "compensation.json");
  command->add_option("--out", call->folder, "folder of results")->capture_default_str();
  command->footer(
      "Writes compensation.json (docs/compensation.md).\n"
      "Example: understudy benchmark compensation --machine arm --machines 50 -j 2");
  command->callback([=, &action] { action = [=] { return run_study(*call); }; });
}

}  // namespace understudy::cli

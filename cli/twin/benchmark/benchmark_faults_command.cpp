#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "report/study/faulted_prints_report.h"
#include "studies/faults/faulted_prints.h"

namespace understudy::cli {
namespace {

struct FaultsCall {
  studies::FaultedPrintsRequest request;
  std::string folder = "out/faults";
  OutputOptions told;
};

int run_faults(const FaultsCall& call) {
  studies::FaultedPrintsRequest request = call.request;
  check_jobs(request.threads);
  request.command = command_line();
  OutputFolder out(call.folder);
  const auto folder = std::filesystem::path(call.folder).lexically_normal();
  const std::filesystem::path named = folder.has_filename() ? folder : folder.parent_path();
  request.folder = out.path();
  request.named = named.string();
  request.journal = named.string() + ".journal";
  if (std::filesystem::exists(request.journal))
    fmt::print(stderr, "goes on with {}; delete it to begin anew\n", request.journal.string());
  studies::FaultedPrints prints;
  {
    ProgressLine line(!call.told.quiet);
    prints = studies::run_faulted_prints(request, line.teller());
  }
  const std::string json = report::faulted_prints_json(prints);
  write_file(out.path() / "faults.json", json);
  write_file(out.path() / "runs.csv", report::faulted_prints_csv(prints));
  stop_if_interrupted();
  out.commit();
  const std::string files =
      fmt::format("{}\n{}\n", (named / "faults.json").string(), (named / "runs.csv").string());
  print_answer(call.told, {report::faulted_prints_table(prints) + files, files, json});
  return prints.good() ? kGood : kNo;
}

}  // namespace

void add_benchmark_faults(CLI::App& benchmark, Action& action) {
  auto call = std::make_shared<FaultsCall>();
  auto& request = call->request;
  auto* command = benchmark.add_subcommand(
      "faults", "Random prints under random faults: is any spoilt part answered with a go?");
  command
      ->add_option("--runs", request.runs, "rehearsals; of 18 each fault has one and two are without a fault")
      ->capture_default_str();
  command->add_option("--seed", request.seed, "of prints, built machines, faults and all noise")
      ->check(seed_check())
      ->capture_default_str();
  command
      ->add_option("--machine", request.machines,
                   "a name under models/ or a machine.yaml, may be given again; else all that print")
      ->allow_extra_args(false);
  add_jobs(*command, request.threads);
  add_output_options(*command, call->told, "the names of the files alone", "faults.json");
  command->add_option("--out", call->folder, "folder of results")->capture_default_str();
  command->footer(
      "Writes faults.json, runs.csv, and the programs and machines (docs/faults.md). Exit status 1: a spoilt "
      "part was answered with a go.\nExample: understudy benchmark faults --runs 400 --seed 2 -j 2");
  command->callback([=, &action] { action = [=] { return run_faults(*call); }; });
}

}  // namespace understudy::cli

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/twin/campaign/campaign_call.h"
#include "cli/twin/campaign/campaign_command.h"
#include "cli/twin/campaign/campaign_slurm.h"
#include "cli/twin/campaign/campaign_workers.h"
#include "cli/twin/planned_program.h"
#include "cli/twin/rehearse_into.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/process/memory.h"
#include "core/version.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/request/memory_need.h"
#include "report/page/campaign_page.h"
#include "report/study/campaign_report.h"
#include "report/summary_json.h"
#include "studies/campaign/campaign_file.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;

studies::CampaignTools tools() {
  studies::CampaignTools tools;
  tools.plan = write_planned;
  tools.planner_options = planner_options;
  tools.plan_sha256 = sources_sha256;
  tools.summary_json = report::summary_json;
  return tools;
}

studies::StoreHeader header_of(const studies::Campaign& campaign, studies::RunInputs& inputs) {
  studies::StoreHeader header{campaign.name, inputs.inputs_sha256(), kVersion, {}};
  for (const auto& parameter : campaign.parameters) header.parameters.push_back(parameter.key);
  return header;
}

void check_memory_of(OpenCampaign& open, int workers) {
  constexpr double kGiga = 1e9;
  const double one = memory_of_a_run(open);
  const auto there = static_cast<double>(available_memory());
  if (there == 0 || workers * one <= there) return;
  throw InputError(fmt::format("{} workers need about {:.1f} GB of memory, {:.1f} GB are free: --workers {}",
                               workers, workers * one / kGiga, there / kGiga,
                               std::max(1, static_cast<int>(there / one))));
}

/// One run as `understudy rehearse` would show it.
int run_only(const CampaignCall& call) {
  const studies::Campaign campaign = studies::load_campaign(call.file);
  const studies::RunPlan plan(campaign);
  if (*call.only >= plan.size())
    throw InputError(
        fmt::format("--only {} is outside 0..{}, the runs of {}", *call.only, plan.size() - 1, call.file));
  studies::RunInputs inputs(campaign, tools());
  const std::string folder = call.folder.empty() ? fmt::format("run-{}", *call.only) : call.folder;
  OutputFolder out(folder);
  const rehearsal::Record record =
      rehearse_into(inputs.request(plan.run(*call.only)), out.path(), call.told.quiet);
  stop_if_interrupted();
  out.commit();
  const std::string verdict =
      fmt::format("{}: {}\n", record.title, rehearsal::headline(rehearsal::grade_of(record)));
  print_answer(call.told,
               {fmt::format("{}report: {}\n", verdict, (fs::path(folder) / "report.html").string()), verdict,
                report::summary_json(record)});
  return record.go ? kGood : kNo;
}

/// What a worker of this campaign is started with.
std::vector<std::string> worker_words(const CampaignCall& call) {
  return {"campaign", call.file, "--out", call.folder};
}

int run_here(const CampaignCall& call, OpenCampaign& open) {
  std::uint64_t rounds = 0;
  LocalWorkers workers(worker_words(call), open.folder, call.workers);
  for (const std::uint64_t look : open.plan.looks()) {
    rounds = look;
    const std::uint64_t end = look * open.plan.runs_a_round();
    const std::vector<std::uint64_t> missing = open.folder.missing(end);
    if (!missing.empty()) {
      ProgressLine line(!call.told.quiet, {"runs", static_cast<double>(missing.size())});
      workers.run(missing, open.plan, open.inputs, line.teller());
    }
    open.folder.merge(end);
    if (studies::narrow_enough(open.campaign, open.plan, look, open.rows)) break;
  }
  tell_result(open, rounds, call.told);
  return kGood;
}

int run_whole(const CampaignCall& call) {
  if (call.workers < 1 || call.workers > 1024)
    throw InputError(fmt::format("--workers {} is outside 1..1024", call.workers));
  OpenCampaign open(call);
  open.inputs.check();
  if (!call.slurm) check_memory_of(open, call.workers);
  if (call.slurm) check_slurm();
  open.folder.take(call.resume);
  return call.slurm ? run_on_slurm(call, open) : run_here(call, open);
}

int run_campaign(CampaignCall call) {
  if (call.only) return run_only(call);
  if (call.folder.empty()) call.folder = "campaign";
  if (call.worker.empty() && call.task.empty() && !call.merge) return run_whole(call);
  OpenCampaign open(call);
  if (!call.worker.empty()) return run_campaign_worker(open.folder, call.worker, open.plan, open.inputs);
  if (!call.task.empty()) return run_slurm_task(call, open);
  return run_slurm_merge(*call.merge, open);
}

}  // namespace

OpenCampaign::OpenCampaign(const CampaignCall& call)
    : campaign(studies::load_campaign(call.file)),
      plan(campaign),
      inputs(campaign, tools()),
      folder(call.folder, header_of(campaign, inputs)),
      rows([this](std::uint64_t begin, std::uint64_t end) { return folder.rows(begin, end); }) {}

void write_result(const OpenCampaign& open, std::uint64_t rounds) {
  const studies::CampaignResult result = studies::evaluate(open.campaign, open.plan, rounds, open.rows);
  const fs::path& folder = open.folder.path();
  write_file(folder / "table.csv", report::campaign_csv(open.campaign, result));
  write_file(folder / "campaign.json",
             report::campaign_json(open.campaign, result, open.folder.header().inputs_sha256));
  write_file(folder / "campaign.html", report::campaign_html(open.campaign, result));
}

void tell_result(const OpenCampaign& open, std::uint64_t rounds, const OutputOptions& told) {
  write_result(open, rounds);
  const studies::CampaignResult result = studies::evaluate(open.campaign, open.plan, rounds, open.rows);
  const fs::path& folder = open.folder.path();
  std::string files;
  for (const char* name : {"table.csv", "campaign.html", "runs.sqlite"})
    files += (folder / name).string() + "\n";
  print_answer(told, {report::campaign_table(open.campaign, result) + files, files,
                      read_file(folder / "campaign.json")});
}

double memory_of_a_run(OpenCampaign& open) {
  double most = 0;
  const std::uint64_t runs = std::min<std::uint64_t>(open.plan.runs_a_round(), 64);
  for (std::uint64_t i = 0; i < runs; ++i) {
    const rehearsal::RehearsalRequest request = open.inputs.request(open.plan.run(i));
    most = std::max(most, rehearsal::memory_need(request, rehearsal::runs_at_most(request)));
  }
  return most;
}

void add_campaign(CLI::App& app, Action& action) {
  auto call = std::make_shared<CampaignCall>();
  call->workers = hardware_threads();
  auto* command = app.add_subcommand(
      "campaign", "Scenarios on many built machines and many values: how probable a good print is");
  command->footer(
      "Example: understudy campaign scenarios/campaigns/bottle-aim.yaml --workers 2 --out bottle-aim");
  command->add_option("file", call->file, "campaign file (docs/campaigns.md)")->required();
  command->add_option("--workers", call->workers, "processes; the tables do not depend on it")
      ->capture_default_str();
  command->add_option("--out", call->folder,
                      "folder of runs and tables; without it `campaign`, with --only run-N");
  command->add_flag("--resume", call->resume, "go on with the runs that the folder holds");
  command->add_option("--only", call->only,
                      "rehearse this one run, and write its summary, report and pictures");
  add_output_options(*command, call->told, "the names of the files alone; with --only the verdict",
                     "campaign.json, with --only the summary,");
  add_slurm_options(*command, *call);
  for (const auto& [name, word] : {std::pair{"--worker", &call->worker}, std::pair{"--task", &call->task},
                                   std::pair{"--todo", &call->todo}})
    command->add_option(name, *word)->group("");
  command->add_option("--merge", call->merge)->group("");
  command->callback([=, &action] { action = [=] { return run_campaign(*call); }; });
}

}  // namespace understudy::cli

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/progress.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "report/picture/png.h"
#include "report/picture/workspace_picture.h"
#include "report/workspace_report.h"
#include "studies/workspace/workspace_study.h"

namespace understudy::cli {
namespace {

struct WorkspaceCall {
  std::string machine = machine::kDefaultMachine, folder;
  std::optional<double> tilt_deg, azimuth_deg, step_mm;
  std::vector<double> box_mm;
  bool all_azimuths = false;
  int threads = 0;
  OutputOptions told;
};

studies::WorkspaceOptions options_of(const WorkspaceCall& call) {
  check_jobs(call.threads);
  studies::WorkspaceOptions options;
  if (call.tilt_deg) options.tilt = from_deg(*call.tilt_deg);
  if (call.azimuth_deg) options.azimuth = from_deg(*call.azimuth_deg);
  options.all_azimuths = call.all_azimuths;
  if (!call.box_mm.empty()) {
    options.box.emplace();
    for (std::size_t i = 0; i < 6; ++i) (*options.box)[i] = from_mm(call.box_mm[i]);
  }
  if (call.step_mm) options.step = from_mm(*call.step_mm);
  options.threads = call.threads;
  options.command = command_line();
  return options;
}

int run_workspace(const WorkspaceCall& call) {
  const auto machine = machine::load_machine(call.machine);
  auto study = studies::plan_workspace(machine, options_of(call));
  const std::string folder = call.folder.empty() ? "out/workspace-" + machine.name : call.folder;
  OutputFolder out(folder);
  std::string json;
  {
    ProgressLine line(!call.told.quiet);
    studies::evaluate(study, [&](double share) { line.show(share, "workspace of " + machine.name); });
    line.show(1, "drawing");
    json = report::workspace_json(study);
    write_file(out.path() / "workspace.json", json);
    write_file(out.path() / "workspace.png", report::encode_png(report::workspace_picture(study)));
  }
  stop_if_interrupted();
  out.commit();
  const std::filesystem::path written(folder);
  const std::string files =
      fmt::format("{}\n{}\n", (written / "workspace.json").string(), (written / "workspace.png").string());
  print_answer(call.told, {report::workspace_table(study) + "\n" + files, files, json});
  return kGood;
}

}  // namespace

void add_workspace(CLI::App& app, Action& action) {
  auto call = std::make_shared<WorkspaceCall>();
  auto* command = app.add_subcommand("workspace", "Where the tool can go, and which limit binds elsewhere");
  add_machine_option(*command, call->machine);
  command->add_option("--tilt", call->tilt_deg,
                      "of the tool's axis from upright, 0..180 degrees; else as at home");
  command->add_option("--azimuth", call->azimuth_deg,
                      "that the axis leans to, degrees from x towards y; else as at home");
  command->add_flag("--all-azimuths", call->all_azimuths,
                    "count a point only if it can be reached towards all 12 azimuths, 30 degrees apart");
  command->add_option("--box", call->box_mm, "x0,x1,y0,y1,z0,z1 in mm, in the frame of programs")
      ->delimiter(',')
      ->expected(6);
  command->add_option("--step", call->step_mm,
                      "between points, mm; else a fortieth of the box's longest side");
  add_jobs(*command, call->threads);
  add_output_options(*command, call->told, "the names of the files alone", "workspace.json");
  command->add_option("--out", call->folder, "folder of results; else out/workspace-<machine>");
  command->footer(
      "Without --box: a hexapod's 100 mm cube about home; else the table's area, as high as the axis that\n"
      "lifts tool or work reaches (the table's shorter side where there is none).\n"
      "Writes workspace.json (docs/workspace.md) and workspace.png.");
  command->callback([=, &action] { action = [=] { return run_workspace(*call); }; });
}

}  // namespace understudy::cli

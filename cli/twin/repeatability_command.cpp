#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/units.h"
#include "machine/description.h"
#include "report/study/repeatability_report.h"
#include "studies/repeatability/repeatability.h"

namespace understudy::cli {
namespace {

struct RepeatabilityCall {
  std::string machine, folder;
  std::vector<double> centre_mm{0, 0, 100};
  double edge_mm = 250, lean_deg = 0;
  studies::RepeatabilityOptions options;
  OutputOptions told;
};

int run_repeatability(const RepeatabilityCall& call) {
  studies::RepeatabilityOptions options = call.options;
  for (int i = 0; i < 3; ++i) options.centre[i] = from_mm(call.centre_mm[static_cast<std::size_t>(i)]);
  options.edge = from_mm(call.edge_mm);
  options.lean = from_deg(call.lean_deg);
  options.command = command_line();
  const auto machine = machine::load_machine(call.machine);
  const std::filesystem::path folder =
      call.folder.empty() ? "out/repeatability-" + machine.name : call.folder;
  OutputFolder out(folder);
  const studies::Repeatability study = studies::repeatability(machine, options);
  const std::string json = report::repeatability_json(study);
  write_file(out.path() / "repeatability.json", json);
  out.commit();
  const std::string file = (folder / "repeatability.json").string() + "\n";
  print_answer(call.told, {report::repeatability_table(study) + "\n\n" + file, file, json});
  return kGood;
}

}  // namespace

void add_repeatability(CLI::App& app, Action& action) {
  auto call = std::make_shared<RepeatabilityCall>();
  auto* command =
      app.add_subcommand("repeatability", "How far apart positions lie that are approached again (ISO 9283)");
  add_machine_option(*command, call->machine)->required();
  command->add_option("--centre", call->centre_mm, "of the standard's cube, mm, in the frame of programs")
      ->expected(3)
      ->capture_default_str();
  command->add_option("--edge", call->edge_mm, "of the cube, mm")->capture_default_str();
  command->add_option("--lean", call->lean_deg, "of the tool from upright, deg")->capture_default_str();
  command->add_option("--cycles", call->options.cycles, "approaches of a pose in a test")
      ->capture_default_str();
  command->add_option("--tests", call->options.tests, "of each pose, whose mean is told")
      ->capture_default_str();
  command->add_option("--friction", call->options.friction, "of every axis, N m or N; else the machine's");
  command->add_flag("--one-side", call->options.one_side, "approach from the same side each time");
  command->add_option("--seed", call->options.seed, "of the sides that axes come from")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("--out", call->folder, "folder of results; else out/repeatability-<machine>");
  add_output_options(*command, call->told, "the name of the file alone", "repeatability.json");
  command->footer(
      "Five poses: the centre of the cube and four corners of a diagonal plane, 0.4 edges from the centre.\n"
      "Only the play of the axes scatters. Writes repeatability.json.");
  command->callback([=, &action] { action = [=] { return run_repeatability(*call); }; });
}

}  // namespace understudy::cli

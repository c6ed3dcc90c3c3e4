#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "cli/twin/registration_options.h"
#include "control/registration/part_pose_file.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "machine/fixture_file.h"
#include "rehearsal/rehearse.h"
#include "report/summary_json.h"

namespace understudy::cli {
namespace {

struct RegisterCall {
  rehearsal::RehearsalRequest request;
  std::string output;
  OutputOptions told;
};

control::PartPose pose_of(const RegisterCall& call, const rehearsal::Record& record) {
  const rehearsal::RegistrationFigures& figures = *record.registration;
  const control::PartFit& fit = *figures.fit;
  const std::string shape = machine::find_fixture(call.request.fixture);
  return {record.fixture_name,
          sha256_hex(read_file(shape)),
          record.machine_word,
          record.provenance.machine_sha256,
          fit.X_W,
          fit.reference_W,
          fit.covariance,
          figures.unseen};
}

void tell(const RegisterCall& call, const rehearsal::Record& record, bool found) {
  if (call.told.json) {
    fmt::print("{}", report::summary_json(record));
    return;
  }
  fmt::print("{} on {}: {}\n", record.fixture_name, record.machine_name, found ? "found" : "not found");
  if (call.told.quiet) return;
  for (const auto& finding : record.findings)
    if (finding.severity == rehearsal::Severity::error)
      fmt::print("  {}: {}\n", finding.kind, finding.message);
  print_registration(*record.registration);
  if (found) fmt::print("pose: {}\n", call.output);
}

int run_register(const RegisterCall& call) {
  check_writable(call.output);
  rehearsal::RehearsalRequest request = call.request;
  request.registration.wanted = true;
  request.gap_control = "off";
  request.keep_scene = false;
  request.compare_without_gap_control = false;
  request.command = command_line();
  rehearsal::Record record;
  {
    ProgressLine line;
    record =
        rehearsal::rehearse(request, [&](double share, const std::string& what) { line.show(share, what); });
  }
  stop_if_interrupted();
  if (!record.registration) throw MachineError("the machine was not run");
  const rehearsal::RegistrationFigures& figures = *record.registration;
  const bool found = figures.fit && record.go;
  if (found) write_file(call.output, control::write_part_pose(pose_of(call, record), command_line()));
  tell(call, record, found);
  return found ? kGood : kNo;
}

}  // namespace

void add_register(CLI::App& app, Action& action) {
  auto call = std::make_shared<RegisterCall>();
  call->request.engine = "quasistatic";
  auto* command = app.add_subcommand(
      "register", "Find where a clamped part stands, by the twin's own gap sensor (docs/registration.md)");
  command
      ->add_option("--fixture", call->request.fixture, "the part: an STL in mm, or a name under models/parts")
      ->required();
  add_machine_option(*command, call->request.machine);
  add_registration_options(*command, call->request.registration);
  command
      ->add_option("--engine", call->request.engine,
                   "plant: mujoco, bullet (hexapods, and arms over a table that stands still), quasistatic")
      ->capture_default_str();
  command->add_option("--as-built", call->request.as_built,
                      "the machine and the part that stand there, as for `rehearse`");
  command->add_option("--seed", call->request.seed, "of the as-built errors and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "pose of the part with its covariance, a .yaml")
      ->required();
  add_output_options(*command, call->told, "whether the part was found, in one line",
                     "the summary of the run");
  command->footer(
      "Example: understudy register --fixture bottle --as-built manufactured --seed 4 -o pose.yaml\n"
      "`understudy rehearse --part-pose pose.yaml` prints where it stands; `rehearse --register` finds the "
      "part and prints in one.");
  command->callback([=, &action] { action = [=] { return run_register(*call); }; });
}

}  // namespace understudy::cli

#include "cli/drive/identify_command.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calibration/identify/identify.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "core/yaml/changed_file.h"
#include "machine/file/beside_machine.h"
#include "machine/file/calibration_section.h"
#include "machine/file/section_text.h"
#include "report/calibration/identify_summary.h"

namespace understudy::cli {
namespace {

struct IdentifyCall {
  calibration::IdentifyRequest request;
  std::vector<double> noise;  ///< um and, for turns, arcmin
  std::string output, as_built, summary;
  OutputOptions told;
};

bool measured_behind_play(const calibration::Identification& found) {
  return !found.axes.empty() && found.axes.front().load.has_value();
}

/// A chain's plays stand among its axes: the file with these values changed.
std::string chain_file(const calibration::Identification& found) {
  std::string file = found.machine.file.string();
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    const calibration::IdentifiedAxis& axis = found.axes[i];
    if (!axis.load || !axis.load->told(calibration::AxisParameter::play)) continue;
    const double play = axis.load->of(calibration::AxisParameter::play);
    file = axis.angle
               ? with_change(file, fmt::format("axes.{}.play_arcmin", i + 1),
                             fmt::format("{:.6f}", 60 * to_deg(play)))
               : with_change(file, fmt::format("axes.{}.play_um", i + 1), fmt::format("{:.6f}", to_um(play)));
  }
  return file;
}

StagedFile staged_machine(const calibration::Identification& found, const std::string& path) {
  if (found.machine.is_chain()) return {path, machine::machine_file_text(chain_file(found))};
  return machine::staged_with_section(found.machine.file,
                                      machine::calibration_section(found.machine, found.stored), path);
}

int run_identify(const IdentifyCall& call) {
  machine::check_machine_output(call.output);
  for (const std::string& file : {call.as_built, call.summary})
    if (!file.empty()) check_writable(file);
  calibration::IdentifyRequest request = call.request;
  request.command = command_line();
  if (!call.noise.empty()) request.noise_length = kMicrometre * call.noise[0];
  if (call.noise.size() > 1) request.noise_angle = from_deg(call.noise[1] / 60);
  const calibration::Identification found = calibration::identify(request);
  const bool measured = measured_behind_play(found);
  std::unique_ptr<StagedFile> machine;
  std::vector<std::unique_ptr<StagedFile>> companions;
  if (measured) {
    machine.reset(new StagedFile(staged_machine(found, call.output)));
    companions = machine::staged_companions(found.machine.file, call.output);
  }
  std::optional<StagedFile> urdf =
      measured ? machine::staged_urdf(found.machine.file, call.output) : std::nullopt;
  std::optional<StagedFile> as_built, summary;
  if (!call.as_built.empty()) as_built.emplace(call.as_built, calibration::as_built_text(found));
  if (!call.summary.empty()) summary.emplace(call.summary, report::identify_json(found));
  stop_if_interrupted();
  for (auto* file : {&summary, &as_built, &urdf})
    if (*file) (*file)->commit();
  for (const auto& file : companions) file->commit();
  if (machine) machine->commit();
  const std::string end =
      machine ? fmt::format("machine: {}\n", call.output)
              : "no machine file is written: the record tells none of its parameters (docs/identify.md)\n";
  print_answer(call.told, {report::identify_text(found) + end, end, report::identify_json(found)});
  return machine ? kGood : kNo;
}

}  // namespace

void add_identify(CLI::App& app, Action& action) {
  auto call = std::make_shared<IdentifyCall>();
  auto* command = app.add_subcommand(
      "identify", "Find play, zero offsets, leads and lag of a machine from a port record");
  command
      ->add_option("record", call->request.record,
                   "of `understudy drive` or `rehearse --record` (docs/port-record.md)")
      ->required();
  add_machine_option(*command, call->request.machine);
  command
      ->add_option("--noise", call->noise,
                   "um[,arcmin]: 1 sigma of an encoder behind the play; else what its counts and the motor's "
                   "steps leave")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(CLI::PositiveNumber);
  command->add_option("-o,--output", call->output, "machine file with what was found, a .yaml")->required();
  command->add_option("--as-built-out", call->as_built,
                      "also an as-built file, by which a twin follows the record");
  command->add_option("--summary", call->summary, "also all figures with their covariance, JSON");
  add_output_options(*command, call->told, "the name of the machine file alone", "the summary");
  command->footer(
      "understudy identify drive.record --machine M -o found/machine.yaml --as-built-out found/built.yaml\n"
      "understudy rehearse --replay drive.record --machine M --as-built found/built.yaml");
  command->callback([=, &action] { action = [=] { return run_identify(*call); }; });
}

}  // namespace understudy::cli

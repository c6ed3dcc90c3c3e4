#include "cli/calibration/measure_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/interrupt.h"

namespace understudy::cli {

void add_measure_options(CLI::App& command, const std::shared_ptr<MeasureCall>& call) {
  command
      .add_option("--rig", call->rig,
                  "rig.yaml: the two cameras, boards and targets (docs/measuring-pictures.md)")
      ->required();
  command.add_option("-o,--output", call->output, "CSV to write; without it, standard output");
  add_quiet_option(command, call->told, "no progress");
}

void add_commanded_options(CLI::App& command, const std::shared_ptr<MeasureCall>& call) {
  command
      .add_option("--commanded", call->commanded,
                  "CSV of the poses that the machine was sent to, as sample-poses writes it: row n is pose "
                  "n. It tells "
                  "which target is which")
      ->required();
  command
      .add_option("--machine", call->machine,
                  "whose axes the table has: name under models/ or a machine.yaml")
      ->capture_default_str();
}

void check_output(const MeasureCall& call) {
  if (!call.output.empty()) check_writable(call.output);
}

calibration::Measurements read_commanded(const MeasureCall& call) {
  return calibration::read_measurements(call.commanded, machine::load_machine(call.machine),
                                        calibration::kReferenceNoise);
}

const calibration::MeasuredPose& row_of_pose(const calibration::Measurements& commanded, int pose,
                                             const std::string& file) {
  if (static_cast<std::size_t>(pose) > commanded.poses.size())
    throw InputError({file, 0, 0}, fmt::format("is of pose {}; {} has {} rows", pose, commanded.file,
                                               commanded.poses.size()));
  return commanded.poses[static_cast<std::size_t>(pose) - 1];
}

void report_left_out(const std::string& file, const std::string& why) {
  fmt::print(stderr, "{}: {}; left out\n", file, why);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

int write_table(const MeasureCall& call, const std::string& table, std::size_t rows,
                const std::string& summary) {
  stop_if_interrupted();
  if (rows == 0) {
    fmt::print(stderr, "{}nothing was measured, nothing is written\n", summary);
    return kNo;
  }
  if (call.output.empty()) {
    fmt::print("{}", table);
    fmt::print(stderr, "{}", summary);
    return kGood;
  }
  write_file(call.output, table);
  fmt::print("{}", summary);
  return kGood;
}

void add_measure(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("measure", "Measure boards, targets and poses in pictures of two cameras");
  command->require_subcommand(1);
  add_measure_board(*command, action);
  add_measure_targets(*command, action);
  add_measure_pose(*command, action);
}

}  // namespace understudy::cli

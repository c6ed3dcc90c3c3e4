#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calibration/gap_sensor/calibrate_gap_sensor.h"
#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "core/interrupt.h"
#include "machine/default_machine.h"
#include "machine/file/gap_sensor_section.h"
#include "machine/file/section_text.h"
#include "report/calibration/gap_sensor_summary.h"

namespace understudy::cli {
namespace {

struct GapSensorCall {
  std::string table, output;
  std::string machine = machine::kDefaultMachine;
  OutputOptions told;
};

int run_gap_sensor(const GapSensorCall& call) {
  machine::check_machine_output(call.output);
  const auto result = calibration::calibrate_gap_sensor(call.table, machine::load_machine(call.machine));
  for (const auto& picture : result.pictures)
    if (picture.dot.status != vision::DotStatus::ok)
      fmt::print(stderr, "{}:{}: {}: {}; left out\n", call.table, picture.row.line, picture.row.picture,
                 to_string(picture.dot.status));
  stop_if_interrupted();
  machine::write_with_section(result.machine.file, machine::gap_sensor_section(result.machine), call.output);
  const std::string file = "machine: " + call.output + "\n";
  print_answer(call.told, {report::gap_sensor_text(result) + file, file,
                           report::gap_sensor_json(result, command_line())});
  return kGood;
}

}  // namespace

CLI::App* add_calibrate_gap_sensor(CLI::App& calibrate, Action& action) {
  auto call = std::make_shared<GapSensorCall>();
  auto* command = calibrate.add_subcommand(
      "gap-sensor", "Find how laser and microscope are mounted, from pictures of the dot over a flat");
  command
      ->add_option("table", call->table,
                   "CSV of heights and pictures with at least one known gap (docs/gap-sensor-calibration.md)")
      ->required();
  add_machine_option(*command, call->machine);
  command->add_option("-o,--output", call->output, "calibrated machine file, a .yaml")->required();
  add_output_options(*command, call->told, "the name of the calibrated machine file alone", "the answer");
  command->footer(
      "The table has the columns height_mm, picture, gap_mm and gap_sigma_um; pictures are named relative to "
      "it.\nExample: understudy calibrate gap-sensor gaps/table.csv --machine hexapod -o calibrated.yaml\n"
      "Try it on the twin: understudy sample-gaps --seed 5 -o gaps");
  command->callback([=, &action] { action = [=] { return run_gap_sensor(*call); }; });
  return command;
}

}  // namespace understudy::cli

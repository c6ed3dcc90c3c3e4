#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "calibration/machine/calibrate_machine.h"
#include "cli/calibrate_bundle.h"
#include "cli/calibration_output.h"
#include "cli/command.h"
#include "cli/machine_option.h"
#include "cli/noise_option.h"
#include "cli/plugin_box.h"
#include "core/error.h"

namespace understudy::cli {
namespace {

struct CalibrateCall {
  calibration::CalibrationRequest request;
  std::vector<double> noise;
  std::string output, report;
};

int run_calibrate(const CalibrateCall& call) {
  CalibrationOutput output(call.output, call.report);
  calibration::CalibrationRequest request = call.request;
  request.noise = noise_of(call.noise);
  request.command = command_line();
  warn_of_box(!request.plugin.empty());
  return output.write(calibration::calibrate_machine(request));
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  auto call = std::make_shared<CalibrateCall>();
  auto* command = app.add_subcommand("calibrate", "Find a machine's parameters from measured poses");
  auto* measurements = command->add_option("measurements", call->request.measurements,
                                           "CSV of measured poses, required (docs/calibration-data.md)");
  add_machine_option(*command, call->request.machine);
  command->add_option(
      "--estimator", call->request.estimator,
      "maximum_likelihood (without the option), robust; of hexapods also whitened, ik_residual, "
      "with_deviation, with_play");
  command->add_option("--plugin", call->request.plugin,
                      "command in place of an estimator: reads one problem and writes one answer, JSON "
                      "(docs/calibration-plugins.md)");
  command->add_option("--plugin-timeout", call->request.plugin_limits.time, "of the plug-in, s")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--noise", call->noise,
                   "um,mrad: 1 sigma of a measured pose on each axis, where the file has no columns for it")
      ->delimiter(',')
      ->expected(2);
  auto* output = command->add_option("-o,--output", call->output, "calibrated machine file, a .yaml");
  output->required();
  command->add_option("--report", call->report, "folder for report.html and summary.json");
  auto* gap_sensor = add_calibrate_gap_sensor(*command, action);
  auto* bundle = add_calibrate_bundle(*command, action);
  for (CLI::App* own : {gap_sensor, bundle})  // they have their own
    own->preparse_callback([=](std::size_t) { output->required(false); });
  command->callback([=, &action] {
    if (gap_sensor->parsed() || bundle->parsed()) return;
    // Not by required(): CLI11 would take the sub-command's name for the file.
    if (measurements->count() == 0) throw CLI::RequiredError(measurements->get_name());
    action = [=] { return run_calibrate(*call); };
  });
}

}  // namespace understudy::cli

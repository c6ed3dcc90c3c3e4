#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "calibration/machine/calibrate_machine.h"
#include "calibration/machine/calibrate_measured_rows.h"
#include "cli/calibration/calibrate_bundle.h"
#include "cli/calibration/calibration_output.h"
#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/noise_option.h"
#include "cli/options/output_options.h"
#include "cli/options/plugin_box.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::cli {
namespace {

struct CalibrateCall {
  calibration::CalibrationRequest request;
  std::vector<double> noise, prior;
  std::vector<std::string> measurements, compared;
  std::string columns, output, report, urdf;
  OutputOptions told;
};

/// Tables with a map of their columns, or with positions or orientations alone; nothing for whole poses.
/// Leaves the text of a table of whole poses in `call`: a pipe can be read once.
std::optional<calibration::RowsRequest> rows_request(CalibrateCall& call) {
  calibration::RowsRequest request;
  if (!call.columns.empty()) {
    request.map = calibration::read_column_map(call.columns);
  } else {
    if (call.measurements.empty())
      throw InputError("give a table of measurements, or --columns with a map that names its files");
    const std::string& file = call.measurements.front();
    call.request.text = read_file(file);
    const auto map = calibration::map_of_partial_poses(*call.request.text, file, call.request.machine);
    if (!map && (call.measurements.size() > 1 || !call.compared.empty()))
      throw InputError("several tables, and --compare, need --columns (docs/measurements.md)");
    if (!map) return std::nullopt;
    request.map = *map;
  }
  // Rows that do not agree with the others are left out of either.
  const std::string& estimator = call.request.estimator;
  const bool of_rows = estimator.empty() || estimator == "maximum_likelihood" || estimator == "robust";
  if (!call.request.plugin.empty() || !of_rows)
    throw InputError(
        "--plugin, and --estimator other than maximum_likelihood and robust, take whole poses in the columns "
        "of docs/calibration-data.md");
  request.measurements = call.measurements;
  request.compared = call.compared;
  request.machine = call.request.machine;
  request.noise = noise_of(call.noise);
  if (!call.prior.empty()) request.prior = {call.prior[0] * kMillimetre, call.prior[1] * kDegree};
  request.command = command_line();
  return request;
}

int run_calibrate(CalibrateCall call) {
  CalibrationOutput output(call.output, call.report, call.urdf);
  if (auto rows = rows_request(call))
    return output.write(with_progress(!call.told.quiet,
                                      [&](const Progress& progress) {
                                        rows->progress = progress;
                                        return calibration::calibrate_measured_rows(*rows);
                                      }),
                        call.told);
  if (!call.prior.empty()) throw InputError("--prior is of tables with --columns (docs/measurements.md)");
  calibration::CalibrationRequest request = call.request;
  request.measurements = call.measurements.front();
  request.noise = noise_of(call.noise);
  request.command = command_line();
  warn_of_box(!request.plugin.empty());
  return output.write(with_progress(!call.told.quiet,
                                    [&](const Progress& progress) {
                                      request.progress = progress;
                                      return calibration::calibrate_machine(request);
                                    }),
                      call.told);
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  auto call = std::make_shared<CalibrateCall>();
  auto* command = app.add_subcommand("calibrate", "Find a machine's parameters from measured poses");
  auto* measurements = command->add_option(
      "measurements", call->measurements,
      "CSV of measured poses (docs/calibration-data.md); with --columns tables of any kind");
  command->add_option("--columns", call->columns,
                      "map of the columns of other tables, a .yaml (docs/measurements.md)");
  command->add_option(
      "--compare", call->compared,
      "tables that are not fitted, only compared with the result; a .yaml is a map that names "
      "its tables");
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
  command
      ->add_option("--prior", call->prior,
                   "mm,deg: 1 sigma of how far a parameter is from its drawing where rows tell nothing, with "
                   "--columns (without the option 10,3.3)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1e-6, 1e3));
  auto* output = command->add_option("-o,--output", call->output, "calibrated machine file, a .yaml");
  output->required();
  command->add_option("--urdf-out", call->urdf,
                      "also write the calibrated machine as a URDF (open chains): its own with other "
                      "origins, where it names one");
  command->add_option("--report", call->report, "folder for report.html and summary.json");
  add_quiet_option(*command, call->told, "no progress, and the name of the calibrated machine file alone");
  add_json_option(*command, call->told, "the summary");
  auto* gap_sensor = add_calibrate_gap_sensor(*command, action);
  auto* bundle = add_calibrate_bundle(*command, action);
  for (CLI::App* own : {gap_sensor, bundle})  // they have their own
    own->preparse_callback([=](std::size_t) { output->required(false); });
  command->callback([=, &action] {
    if (gap_sensor->parsed() || bundle->parsed()) return;
    // Not by required(): CLI11 would take the sub-command's name for the file.
    if (measurements->count() == 0 && call->columns.empty())
      throw CLI::RequiredError(measurements->get_name());
    action = [=] { return run_calibrate(*call); };
  });
}

}  // namespace understudy::cli

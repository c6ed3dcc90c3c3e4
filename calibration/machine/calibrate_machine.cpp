#include "calibration/machine/calibrate_machine.h"

#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/machine/calibrate_chain.h"
#include "calibration/machine/calibrate_hexapod.h"
#include "calibration/plugin/plugin_estimator.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

constexpr const char* kDefault = "maximum_likelihood";

std::string rejected_lines(const MachineCalibration& result) {
  std::vector<int> lines;
  for (const PoseResidual& pose : result.poses)
    if (!pose.used) lines.push_back(pose.line);
  return fmt::format("{}", fmt::join(lines, ", "));
}

std::unique_ptr<Estimator> estimator_of(const CalibrationRequest& request, const std::string& name,
                                        MachineKind kind) {
  if (request.plugin.empty()) return make_estimator(name, kind);
  return make_plugin_estimator(request.plugin, request.plugin_limits);
}

void warn_of_noise(const CalibrationRequest& request, MachineCalibration& result) {
  if (result.noise_given || request.noise) return;
  result.warnings.push_back(
      fmt::format("the file does not tell the noise of its poses: {:g} um and {:g} mrad "
                  "on each axis are assumed (--noise)",
                  to_um(result.noise.position), 1e3 * result.noise.rotation));
}

}  // namespace

void calibrate_measurements(const Measurements& measurements, const machine::MachineDescription& nominal,
                            const Estimator& estimator, MachineCalibration& result,
                            const Progress& progress) {
  tell(progress, 0, 1, fmt::format("fitting {} poses", measurements.poses.size()));
  if (nominal.is_chain())
    calibrate_chain_machine(measurements, nominal, estimator, result, progress);
  else
    calibrate_hexapod(measurements, nominal, estimator, result, progress);
  if (const std::string lines = rejected_lines(result); !lines.empty())
    result.warnings.push_back("poses rejected as outliers: line " + lines);
  result.machine.calibration = {result.estimator, std::filesystem::path(result.file).filename().string(),
                                measurements.sha256, static_cast<int>(measurements.poses.size()),
                                result.tip.rms};
}

MachineCalibration calibrate_machine(const CalibrationRequest& request) {
  if (!request.estimator.empty() && !request.plugin.empty())
    throw InputError("--estimator and --plugin: give one of them");
  MachineCalibration result;
  result.file = request.measurements;
  result.command = request.command;
  result.estimator = request.estimator.empty() ? kDefault : request.estimator;
  if (!request.plugin.empty()) result.estimator = "plug-in: " + request.plugin;
  if (request.plugin.empty()) make_estimator(result.estimator);  // a wrong name before anything else
  result.noise = request.noise.value_or(kReferenceNoise);
  const machine::MachineDescription nominal = machine::load_machine(request.machine);
  const Measurements measurements =
      request.text ? parse_measurements(*request.text, request.measurements, nominal, result.noise)
                   : read_measurements(request.measurements, nominal, result.noise);
  result.noise_given = measurements.noise_given;
  result.frame = measurements.frame;
  result.machine = nominal;
  warn_of_noise(request, result);
  const auto estimator =
      estimator_of(request, result.estimator, nominal.is_chain() ? MachineKind::chain : MachineKind::hexapod);
  calibrate_measurements(measurements, nominal, *estimator, result, request.progress);
  return result;
}

}  // namespace understudy::calibration

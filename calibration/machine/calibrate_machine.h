// From a table of measured poses to a calibrated machine (docs/calibration-data.md).
#pragma once

#include <optional>
#include <string>

#include "calibration/estimators/estimator.h"
#include "calibration/machine/machine_calibration.h"
#include "calibration/machine/measurement_table.h"
#include "calibration/plugin/child_process.h"
#include "machine/default_machine.h"

namespace understudy::calibration {

struct CalibrationRequest {
  std::string measurements;                        ///< path of a CSV
  std::optional<std::string> text = {};            ///< of that file, where it was read already
  std::string machine = machine::kDefaultMachine;  ///< name or path
  std::string estimator;  ///< empty: maximum_likelihood, or the plug-in where there is one
  std::string plugin;     ///< command in place of an estimator of ours
  ProcessLimits plugin_limits{.time = 60};
  std::optional<MeasurementNoise> noise;  ///< of poses, where the file has none
  std::string command;                    ///< for the record: how a user repeats this
  Progress progress = {};
};

/// Throws InputError, with file and line where one row is at fault, for all that check_identifiability() and
/// read_measurements() refuse, and for a plug-in that gives no machine.
MachineCalibration calibrate_machine(const CalibrationRequest& request);

/// The same of measurements and an estimator that are at hand. `result` comes with its machine (`nominal`),
/// the names of file and estimator, and the noise.
void calibrate_measurements(const Measurements& measurements, const machine::MachineDescription& nominal,
                            const Estimator& estimator, MachineCalibration& result,
                            const Progress& progress = {});

}  // namespace understudy::calibration

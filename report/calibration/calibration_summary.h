// What a calibration prints, and its summary.json.
#pragma once

#include <string>

#include "calibration/machine/machine_calibration.h"

namespace understudy::report {

/// What is printed.
std::string calibration_text(const calibration::MachineCalibration& result);
/// summary.json, schema "understudy.calibration/1".
std::string calibration_json(const calibration::MachineCalibration& result);

}  // namespace understudy::report

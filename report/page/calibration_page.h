// report.html of a calibration.
#pragma once

#include <string>

#include "calibration/machine/machine_calibration.h"

namespace understudy::report {

/// One page that opens from disk without a network.
std::string calibration_html(const calibration::MachineCalibration& result);

}  // namespace understudy::report

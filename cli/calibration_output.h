#pragma once

#include <string>

#include "calibration/machine/calibrate_machine.h"
#include "cli/command.h"

namespace understudy::cli {

/// The calibrated machine file and, unless its name is empty, the folder with page and summary: both or none.
/// Prints the result; the exit status.
int write_calibration(const calibration::MachineCalibration& result, const std::string& machine_file,
                      const std::string& report_folder);

}  // namespace understudy::cli

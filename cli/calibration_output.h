#pragma once

#include <string>

#include "calibration/machine/calibrate_machine.h"
#include "cli/command.h"

namespace understudy::cli {

/// The calibrated machine file and, unless its name is empty, the folder with page and summary: the report
/// is written beside its place before the machine file, and gets its place after it.
/// Prints the result; the exit status.
int write_calibration(const calibration::MachineCalibration& result, const std::string& machine_file,
                      const std::string& report_folder);

}  // namespace understudy::cli

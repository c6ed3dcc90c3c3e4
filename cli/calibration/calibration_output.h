#pragma once

#include <optional>
#include <string>

#include "calibration/machine/calibrate_machine.h"
#include "cli/command.h"
#include "cli/options/output_options.h"
#include "core/file/output_folder.h"

namespace understudy::cli {

/// The calibrated machine file and, unless its name is empty, the folder with page and summary. Made before
/// the work: what cannot be written is refused at once.
class CalibrationOutput {
 public:
  /// A URDF of the calibrated machine goes to `urdf_file` unless its name is empty.
  CalibrationOutput(std::string machine_file, std::string report_folder, std::string urdf_file = "");
  /// All are written beside their places before one gets its name. Prints the result, in the form of `told`;
  /// the exit status.
  int write(const calibration::MachineCalibration& result, const OutputOptions& told = {});

 private:
  std::string machine_file_, report_folder_, urdf_file_;
  std::optional<OutputFolder> report_;
};

}  // namespace understudy::cli

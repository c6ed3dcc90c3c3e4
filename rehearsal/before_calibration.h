// What a calibration is worth to a print: the same program on the same twin, driven by the description as it
// was before.
#pragma once

#include <optional>
#include <string>

#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

/// The print as the description before the calibration would drive it; the twin stays as it is.
struct BeforeCalibration {
  TwinSetup setup;
  std::string machine_before, machine_after;  ///< what files or names they came from
  std::string not_run;                        ///< why the program cannot run with `setup`; empty: it can
};

/// `before` is a machine's name or file, `after` what the set-up's own machine was called. Throws InputError
/// where the two do not describe the same machine: another mechanism, name, drawing or place.
BeforeCalibration before_calibration(const TwinSetup& setup, const std::string& before,
                                     const std::string& after);

/// Throws InputError that begins with `before_said` where the two do not describe the same machine.
void require_same_machine(const machine::MachineDescription& before, const machine::MachineDescription& after,
                          const std::string& before_said, const std::string& after_said);

/// Figures of both open-loop runs; nothing while nothing was extruded. `before_run` is null where it did not
/// run.
std::optional<CalibrationFigures> compare_calibrations(const BeforeCalibration& before,
                                                       const TwinRun* before_run, const TwinRun& after_run);

}  // namespace understudy::rehearsal

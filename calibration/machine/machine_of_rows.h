// Private to this folder: what a fit of rows means for the machine file and its user.
#pragma once

#include "calibration/machine/machine_calibration.h"

namespace understudy::calibration {

/// Throws InputError for a machine whose readings do not tell its pose, or that has no place for a
/// calibration in its file; warns in `result` where the model lacks something.
void require_row_model(const machine::MachineDescription& nominal, MachineCalibration& result);

/// Geometry, what the file stores, parameters, tip. `result.machine` is the nominal one before.
void take_machine(const RowCalibration& found, const RowProblem& problem,
                  const machine::MachineDescription& nominal, MachineCalibration& result,
                  const Progress& progress = {});

}  // namespace understudy::calibration

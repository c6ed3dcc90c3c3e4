#pragma once

#include "calibration/estimators/estimator.h"
#include "calibration/machine/machine_calibration.h"
#include "calibration/machine/measurement_table.h"

namespace understudy::calibration {

/// The hexapod's half of calibrate_machine(): joints, length offsets and what else the estimator knows.
void calibrate_hexapod(const Measurements& measurements, const machine::MachineDescription& nominal,
                       const Estimator& estimator, MachineCalibration& result, const Progress& progress = {});

/// Throws InputError for struts whose drives do not tell their lengths; warns of what no model has. `file`:
/// of the measurements.
void check_hexapod_model(const machine::MachineDescription& machine, const std::string& file,
                         MachineCalibration& result);

/// What an estimation that is ok means for the machine and for its user: geometry, what the file stores,
/// residuals, parameters, tip. `measurements` has a row for each sample of `problem`.
void report_hexapod(const Problem& problem, const Calibration& found, const Unknowns& unknowns,
                    const Measurements& measurements, const machine::MachineDescription& nominal,
                    MachineCalibration& result);

}  // namespace understudy::calibration

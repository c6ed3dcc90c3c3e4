// What tables that were not fitted say of a calibration.
#pragma once

#include "calibration/machine/calibrate_measured_rows.h"
#include "calibration/table/measured_rows.h"

namespace understudy::calibration {

/// Compares request.compared with what `found` made of `fitted`: tables as the map's one, or maps (.yaml)
/// that name tables of their own. Fills `compared`, `compared_files` and a warning for each file that the
/// calibration has moved away from. Throws InputError as read_measured_rows() does.
void compare_tables(const RowsRequest& request, const MeasuredRows& fitted, const RowCalibration& found,
                    const machine::MachineDescription& nominal, MachineCalibration& result);

/// `noise` for rows that tell none.
void assume_noise(const std::optional<MeasurementNoise>& noise, RowProblem& problem);

}  // namespace understudy::calibration

#pragma once

#include "calibration/estimators/estimator.h"
#include "calibration/machine/machine_calibration.h"
#include "calibration/machine/measurement_table.h"

namespace understudy::calibration {

/// The hexapod's half of calibrate_machine(): joints, length offsets and what else the estimator knows.
void calibrate_hexapod(const Measurements& measurements, const machine::MachineDescription& nominal,
                       const Estimator& estimator, MachineCalibration& result);

}  // namespace understudy::calibration

#pragma once

#include "calibration/estimators/estimator.h"
#include "calibration/machine/machine_calibration.h"
#include "calibration/machine/measurement_table.h"

namespace understudy::calibration {

/// The open chain's half of calibrate_machine(): axes, tool and measuring frame.
void calibrate_chain_machine(const Measurements& measurements, const machine::MachineDescription& nominal,
                             const Estimator& estimator, MachineCalibration& result,
                             const Progress& progress = {});

}  // namespace understudy::calibration

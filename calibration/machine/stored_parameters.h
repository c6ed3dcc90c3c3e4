// What the calibrated machine file keeps of an estimation besides the geometry: the covariance of the numbers
// in the file, and the play.
#pragma once

#include "calibration/estimators/chain_calibration.h"
#include "calibration/machine/measurement_table.h"
#include "calibration/problem.h"
#include "machine/calibrated_parameters.h"

namespace understudy::calibration {

/// With the share of the position and rotation of the measuring frame, which move all base joints alike; its
/// strain is no error of a geometry and is left out. No covariance where `found` has none.
machine::CalibratedParameters stored_parameters(const Calibration& found, const Unknowns& unknowns,
                                                const Measurements& measurements,
                                                const machine::MachineDescription& machine);

/// Likewise; the frame moves the work. The file's numbers are those of absorb_zeros(found.parameters).
machine::CalibratedParameters stored_parameters(const ChainCalibration& found,
                                                const Measurements& measurements,
                                                const machine::MachineDescription& machine);

}  // namespace understudy::calibration

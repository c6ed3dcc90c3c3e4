// Whether a table of measured poses is about this machine, in these units.
#pragma once

#include "calibration/machine/measurement_table.h"

namespace understudy::calibration {

/// Throws InputError for poses that no reading of the file explains: other units, another frame, another
/// order of the rows.
void check_plausible(const Measurements& measurements, const machine::MachineDescription& machine);

}  // namespace understudy::calibration

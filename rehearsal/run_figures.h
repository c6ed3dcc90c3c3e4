// The figures of a run, in the units of reports.
#pragma once

#include "machine/description.h"
#include "rehearsal/record.h"
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

/// What came of the filament: fed is printed, purged and missing. `truth`: the machine that the twin holds.
PrintFigures print_figures(const TwinRun& run, const machine::MachineDescription& truth);

/// All sections but `surface` and `calibration`. `without` is the same print without gap control; may be
/// null.
void fill_figures(const TwinRun& run, const TwinRun* without, const machine::MachineDescription& truth,
                  Record& record);

}  // namespace understudy::rehearsal

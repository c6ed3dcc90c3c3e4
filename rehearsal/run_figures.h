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

/// How far the truth of the trace keeps to what the controller states, weighted by the path; both have an
/// entry for each point.
void fill_belief(const std::vector<TracePoint>& trace, const std::vector<GapBelief>& beliefs,
                 GapFigures& gap);

}  // namespace understudy::rehearsal

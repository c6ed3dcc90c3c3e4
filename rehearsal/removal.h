// The workpiece of a machine that mills: what it is before, and what became of it.
#pragma once

#include <memory>
#include <vector>

#include "machine/accepted_errors.h"
#include "machine/description.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"
#include "rehearsal/run_twin.h"
#include "sim/removal/removal.h"

namespace understudy::rehearsal {

/// Null where neither a stock nor a depth of cut is asked for. Throws InputError for a machine that prints,
/// without an intended part, for both a stock and a depth, and for parts that cannot be read or made larger.
std::shared_ptr<const sim::Workblank> prepare_workblank(const SurfaceRequest& request,
                                                        const machine::MachineDescription& machine);

/// Fills record.removal and record.milled, and adds findings: `gouge`, an error, where the mill went deeper
/// into the part than the accepted error of the tip; `left_over`, a warning, where 5 % of what it went over
/// stand out by more than that, and an error where the program takes nothing off.
void study_removal(const TwinRun& run, const machine::AcceptedErrors& accepted, Record& record);

}  // namespace understudy::rehearsal

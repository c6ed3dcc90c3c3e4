// One rehearsal: program + simulated port + observers -> record with a verdict.
#pragma once

#include "core/progress.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"
#include "rehearsal/run_listener.h"

namespace understudy::rehearsal {

/// Throws InputError for bad input, MachineError, which begins with the as-built file if there is one, when
/// the engine fails or the built machine cannot follow, Interrupted. A no-go is a result, not an exception. A
/// program that fails the constraint check (Song 2015, 3.5) is a no-go, too, and is simulated all the same,
/// so that one run tells all: axes stay at the ends of their ranges, joints go beyond theirs, and moves that
/// no axes make are passed over or, where the tool cannot go on behind them, end the print. Lines that cannot
/// be read and filament that cannot be fed are no-goes, too, unless the request is strict. `listener`: sees
/// the main run; may be null.
Record rehearse(const RehearsalRequest& request, const Progress& progress = {},
                RunListener* listener = nullptr);

}  // namespace understudy::rehearsal

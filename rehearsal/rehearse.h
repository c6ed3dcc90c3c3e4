// One rehearsal: program + simulated port + observers -> record with a verdict.
#pragma once

#include "core/progress.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// Throws InputError for bad input, MachineError when the engine fails, Interrupted. A no-go is a result, not
/// an exception. A program that fails the constraint check (Song 2015, 3.5) is a no-go, too, and is simulated
/// all the same, so that one run tells all: axes stay at the ends of their ranges, joints go beyond theirs,
/// and what no axes reach ends the print.
Record rehearse(const RehearsalRequest& request, const Progress& progress = {});

}  // namespace understudy::rehearsal

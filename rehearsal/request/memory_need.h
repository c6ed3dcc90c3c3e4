// The memory of a rehearsal, estimated from the sizes of its files before any is read.
#pragma once

#include <cstdint>

#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// [bytes], rather too many than too few: a base, and for each line of the program and each triangle of the
/// fixture and of the intended part what it leaves in the program, the scene and each simulated run
/// (measured; docs/limits.md). Files that are not there, or are pipes, count nothing. `runs`: simulated at a
/// time.
double memory_need(const RehearsalRequest& request, int runs);

/// The runs that `request` may lead to: the print, the one without gap control, the one before calibration.
int runs_at_most(const RehearsalRequest& request);

/// Throws InputError where more is needed than available_memory(): "needs about 31 GB of memory, ...".
void check_memory(const RehearsalRequest& request);

}  // namespace understudy::rehearsal

// The machine and the part as the rehearsal saw them, drawn for people.
#pragma once

#include "rehearsal/record.h"
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

/// An overview of machine and part, and a close-up of the tool on the path, at the middle of the print (or at
/// home when nothing was simulated).
void add_pictures(const Stage& stage, Record& record);

}  // namespace understudy::rehearsal

// The machine and the part as the rehearsal saw them, drawn for people.
#pragma once

#include "rehearsal/record.h"
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

/// An overview of machine and part, and a close-up of the tool on the path, at the middle of the print (or at
/// home when nothing was simulated); the part as printed, where something was (`printed` may be null).
void add_pictures(const TwinSetup& setup, const sim::Workpiece* printed, Record& record);

}  // namespace understudy::rehearsal

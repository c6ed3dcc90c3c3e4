// Sample records with a replay: machine, beads and program, made by rule.
#pragma once

#include "rehearsal/record.h"

namespace understudy::report {

/// Adds scene, beads along what the trace extrudes, and the bodies of the hexapod.
void add_sample_replay(rehearsal::Record& record);

/// A vase of so many moves, none of which can be merged with its neighbours; findings all along.
rehearsal::Record sample_large(int moves);

}  // namespace understudy::report

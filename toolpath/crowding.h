// Programs that print on the spot, over and over.
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

/// Moves that print and end in one cubic millimetre. Arcs in steps of 5 um through five layers of strokes
/// 0.4 mm wide are 2500. The cost of a rehearsal grows with the square of it.
constexpr int kCrowdingMax = 10'000;  // docs/limits.md

/// Throws InputError at the line of the first move that is too many.
void check_crowding(const Program& program);

}  // namespace understudy::toolpath

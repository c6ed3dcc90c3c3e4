// How long a program takes at least.
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

/// [s], of a move at its feed or of a dwell; 0 of what takes as long as the machine needs.
double least_duration(const Step& step, const Vec3& from_W);

/// From a tip at `start_W`. Throws InputError at the line by whose end the program has taken more than
/// `limit` [s].
void check_duration(const Program& program, const Vec3& start_W, double limit);

}  // namespace understudy::toolpath

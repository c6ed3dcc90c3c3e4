// How much of a print begins in the air: a wrong reading of its rotary words lays it beside what it should
// lie on.
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

/// Of the printed path, in [0, 1]: what lies farther from all that was printed before, and from the lowest
/// printed point's level, than three times the median distance, or than 2 mm where that is less. Looks at no
/// more than 5000 places. 0 where nothing is printed. `start_W` [m]: the tip before the first step.
double floating_share(const Program& program, const Vec3& start_W);

}  // namespace understudy::toolpath

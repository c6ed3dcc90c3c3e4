// Leaves out moves that cannot be made, so that what comes after them can be looked at.
#pragma once

#include <cstddef>
#include <vector>

#include "toolpath/program.h"

namespace understudy::toolpath {

/// Begins at `X_WT_home`. Without the moves of these indexes (ascending), and what goes on at rest where they
/// end. The tool goes by a travel from where the last move before them ended to where the first after them
/// begins; filament that was drawn back meanwhile is drawn back there, or pushed back, but no bead is laid.
void pass_over(Program& program, const Pose& X_WT_home, const std::vector<std::size_t>& impossible);

}  // namespace understudy::toolpath

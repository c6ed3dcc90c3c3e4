// The program as far as the machine can make it, so that one rehearsal tells all.
#pragma once

#include <utility>
#include <vector>

#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

struct Reach {
  std::vector<Finding> findings;                 ///< limits that the whole program breaks
  std::vector<std::pair<int, int>> passed_over;  ///< first and last line of moves that were left out
};

/// Checks the program against the machine's limits. Moves that no axes make are left out of it where the tool
/// can go on behind them by a straight travel; their findings say so. Where it cannot, or nothing that moves
/// would be left, or `keep`, the program stays as it is, and its print ends there.
Reach check_reach(toolpath::Program& program, const machine::MachineDescription& machine, bool keep);

}  // namespace understudy::rehearsal

// A small print drawn at random for a machine: what it lays, and on what.
#pragma once

#include <string>

#include "core/random.h"
#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::studies {

struct DrawnPrint {
  std::string what;     ///< "bottle line", "surface", "layers", "spiral"
  std::string fixture;  ///< a name under models/parts; empty: printed on the table
  toolpath::Program program;
};

/// A piece of the bottle's line, rows over a shipped part, level layers on the table, or a helix into the
/// air; some 5 to 60 mm of bead. Throws InputError where the planner refuses what was drawn: draw again.
DrawnPrint draw_print(const machine::MachineDescription& machine, Random& random);

}  // namespace understudy::studies

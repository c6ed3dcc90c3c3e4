// Cross-sections that a program asks for, line by line.
#pragma once

#include <vector>

#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// [m^2] of bead by line of the file, of the line's last step that prints; 0: nothing programmed. What only
/// fills the nozzle again after a retraction is no bead.
std::vector<float> programmed_areas(const toolpath::Program& program,
                                    const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

// What no print can do with its filament, whatever the machine: found before anything runs.
#pragma once

#include <cstddef>
#include <vector>

#include "machine/description.h"
#include "machine/material.h"
#include "rehearsal/findings/finding.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// Throws InputError with file, and line of each, for extrusion before any temperature is set or at one at
/// which the material is solid, for a bead that no such nozzle lays, and for filament drawn back farther than
/// a hot end is long.
void check_process(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const machine::Material& material);

/// The same as findings, by which the program is mended: its moves stay, filament that cannot be fed is left
/// out, and no more is drawn back than can be. Throws InputError for extrusion before any temperature is set,
/// for more than kMostFaults such places, and where nothing that prints is left.
std::vector<Finding> mend_process(toolpath::Program& program, const machine::MachineDescription& machine,
                                  const machine::Material& material);
constexpr std::size_t kMostFaults = 20;

/// Filament that is fed at a temperature at which the material is not printed: colder is an error, hotter a
/// warning. Of each the farthest, with the first line and the last.
std::vector<Finding> temperature_findings(const toolpath::Program& program,
                                          const machine::Material& material);

}  // namespace understudy::rehearsal

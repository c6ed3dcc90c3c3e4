// The letter that feeds filament in programs that have no E.
#pragma once

#include <optional>
#include <string>

#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {

/// A or B, as programs for Makerbot's printers have it: a letter that grows by nearly the same amount per
/// millimetre of path, so that the beads have the section of a printer's. Nothing for a letter that turns an
/// axis of the machine, and where the program cannot be read so.
std::optional<char> extruder_letter_of(const std::string& text, const std::string& file,
                                       const toolpath::GcodeOptions& options, double filament_diameter);

}  // namespace understudy::rehearsal

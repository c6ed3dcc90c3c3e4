// What the rotary words of a program mean on the machine that is to run it.
#pragma once

#include <optional>

#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {

/// Those that its mechanism has; nothing for a machine without, whose programs state orientation by W I J K.
std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

// What the rotary words B and C of a program mean on the machine that is to run it.
#pragma once

#include <optional>

#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {

/// Those of a five-axis machine; nothing for any other, whose programs tell orientation by W I J K.
std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

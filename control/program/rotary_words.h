// What the rotary words of a program mean on the machine that is to run it.
#pragma once

#include <optional>
#include <string>

#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {

/// Sets what X Y Z mean beside rotary words: `tip`, `machine`, `crossing`; `head:60`, the slides of a machine
/// whose first word tilts its head about a pivot 60 mm above the tip, over a table that the second turns; or
/// `double-head:60`, where both turn the head. Throws InputError for any other word.
void set_coordinates(const std::string& word, toolpath::RotaryWords& rotary);

/// Those that its file maps to axes; nothing for a machine without, whose programs state orientation by
/// W I J K.
std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine);

}  // namespace understudy::control

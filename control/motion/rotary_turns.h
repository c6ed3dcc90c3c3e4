// Programs whose poses are stated by turning axes, as controllers of such machines read them.
#pragma once

#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {

/// Gives each step that moves the turns of the machine's axes at its end, from home on without a leap over a
/// whole turn; the poses stay. Throws InputError for a machine without rotary words, and for a pose that it
/// cannot take.
toolpath::Program with_turns(const toolpath::Program& program, const machine::MachineDescription& machine);

/// Letters and units in which such a program is written for this machine.
toolpath::GcodeStyle rotary_style(const machine::MachineDescription& machine);

}  // namespace understudy::control

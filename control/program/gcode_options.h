// How the reader of G-code is to read a program for a machine: the same in a rehearsal and on the machine.
#pragma once

#include "control/program/dialect_request.h"
#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {

/// Throws InputError for words of the dialect that are none, or not for this machine.
toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine);

/// Puts the temperature that the dialect asks for, if it does, ahead of the program, unless the reader has
/// put it in place of an ignored macro that starts the print.
void heat_first(const DialectRequest& dialect, const machine::MachineDescription& machine,
                toolpath::Program& program);

}  // namespace understudy::control

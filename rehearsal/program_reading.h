// The program of a request, read as the machine and the request say.
#pragma once

#include "machine/description.h"
#include "rehearsal/request/request.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {

/// Throws InputError for words of the dialect that are none, or not for this machine.
toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine);

/// With the temperature that the request asks for ahead of it. Throws InputError as read_gcode() does.
toolpath::Program read_program(const RehearsalRequest& request, const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

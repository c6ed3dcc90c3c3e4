// The program of a request, read as the machine and the request say.
#pragma once

#include <optional>
#include <vector>

#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/request/request.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::rehearsal {

/// Throws InputError for words of the dialect that are none, or not for this machine.
toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine);

/// Of a robot's program. Throws InputError for words that are for G-code alone.
toolpath::RobotOptions robot_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine);

/// With the temperature that the request asks for ahead of it. Throws InputError as read_gcode() and
/// read_robot_program() do, with the command that says more where words mean nothing to this machine.
toolpath::Program read_program(const RehearsalRequest& request, const machine::MachineDescription& machine);

/// What of a robot's program is not rehearsed as its robot runs it; empty for G-code.
std::vector<Finding> robot_program_findings(const RehearsalRequest& request,
                                            const toolpath::Program& program);

/// A finding where its rotary words are for another kind of machine (readings.h).
std::optional<Finding> misread_words(const RehearsalRequest& request, const toolpath::Program& program,
                                     const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

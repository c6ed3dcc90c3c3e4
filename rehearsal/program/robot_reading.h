// What a request says of a robot's program (KRL, RAPID), and what of it is not rehearsed as its robot runs
// it.
#pragma once

#include <string>
#include <vector>

#include "machine/description.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/request/request.h"
#include "toolpath/program.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::rehearsal {

/// Throws InputError for words that are for G-code alone.
toolpath::RobotOptions robot_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine);

/// Throws InputError where a request for G-code says what a robot's signals feed.
void refuse_robot_options(const RehearsalRequest& request);

/// Warnings: moves by axis values, and a program that feeds no filament.
std::vector<Finding> robot_program_findings(const toolpath::Program& program, const std::string& machine);

}  // namespace understudy::rehearsal

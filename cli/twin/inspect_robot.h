// What `understudy inspect` says of a robot's program.
#pragma once

#include "rehearsal/inspection/inspect.h"

namespace understudy::cli {

void print_robot_program(const rehearsal::Inspection& found);

}  // namespace understudy::cli

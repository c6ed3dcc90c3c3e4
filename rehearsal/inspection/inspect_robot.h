// A look at a robot's program before it is rehearsed.
#pragma once

#include <string>

#include "rehearsal/inspection/inspect.h"

namespace understudy::rehearsal {

/// `text` is that of the KRL or RAPID in file `program`. What the program leaves open (its signal, the bead,
/// the way its tool points) is guessed and stands in `request`. Throws InputError as read_robot_program()
/// does.
Inspection inspect_robot(const std::string& program, const std::string& text, const std::string& machine);

}  // namespace understudy::rehearsal

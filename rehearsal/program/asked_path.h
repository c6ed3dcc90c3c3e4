// What a compensated program was made of: its tip errors are counted from there.
#pragma once

#include <memory>
#include <string>

#include "machine/description.h"
#include "rehearsal/request/request.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"

namespace understudy::rehearsal {

/// Path of the original of a compensated program that is still there, byte for byte: as the program names it,
/// or beside it. Empty: it is no compensated program, or its original is gone or another.
std::string original_of(const std::string& program);

/// Where the original asks for the tool; null where there is none. Throws InputError where it cannot be read.
std::shared_ptr<const toolpath::RewrittenPath> asked_path(const RehearsalRequest& request,
                                                          const machine::MachineDescription& machine);

}  // namespace understudy::rehearsal

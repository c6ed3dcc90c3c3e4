// The command that a line of G-code begins with, before its words are read.
#pragma once

#include <string>
#include <string_view>

#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

/// Column, from 1, of what a line begins with.
int column_of(std::string_view line);

/// "G1", "START_PRINT".
std::string first_command(std::string_view line);

/// A command of this reader's keeps its meaning, whatever a macro makes of it.
bool has_meaning(const std::string& command);

/// Letters and commands of the dialect. Throws InputError for a switching command that means something else.
Letters letters_of(const GcodeOptions& options);

}  // namespace understudy::toolpath

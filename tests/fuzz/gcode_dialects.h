// The dialects that programs are read in, and what is asked of a program that was accepted in one.
#pragma once

#include <string>
#include <vector>

#include "toolpath/gcode/gcode.h"

namespace understudy::fuzz {

struct Dialect {
  std::string name;
  toolpath::GcodeOptions options;
};

/// Of all arcs of a program: a few words may ask for as many as may be, and what is made of them is checked.
constexpr std::size_t kChords = 20'000;

/// Of printers; with filament on A; of rotary tables: the tip, the slides, and slides of axes that cross.
const std::vector<Dialect>& dialects();

/// Throws Finding where the program holds a number that is not finite, or where it is written and then not
/// read back as the same program within the digits that are written.
void check_program(const toolpath::Program& program, const toolpath::GcodeOptions& options);

}  // namespace understudy::fuzz

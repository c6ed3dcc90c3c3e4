// What can still be read of a line that as a whole cannot.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

struct SalvagedLine {
  bool moves = false;       ///< it has words of a motion; else of a nozzle, fan or dwell
  bool arc = false;         ///< of G2, G3, G5
  std::vector<Word> words;  ///< with their numbers, one of each letter
  /// What the line says of where the tool goes and of filament: letters out of X Y Z, B C (the rotary words),
  /// E, and W (an orientation), whether their numbers can be read or not; and those whose cannot.
  std::string named, lost;
};

/// Nothing where the line may be more than a move, a temperature, a fan or a dwell, or has words of another
/// kind of machine: then what follows it means something else without it. `arc`: the motion in force before
/// it is one.
std::optional<SalvagedLine> salvage(std::string_view line, const Letters& letters, bool arc);

}  // namespace understudy::toolpath

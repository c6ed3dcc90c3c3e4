// How the programs of a machine are written: what the section `gcode` of its file says beside the axes that
// words state.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/units.h"

namespace understudy::machine {

struct ProgramDialect {
  /// What X Y Z are before the program says: `tip` on the work, `machine` (the slides), or `crossing`: as if
  /// all turning axes ran through the pivot.
  std::string coordinates = "tip";
  Vec3 pivot_W{0, 0, 0};             ///< [m], of `crossing`, with all words at 0
  Vec3 tip_from_pivot_W{0, 0, 0};    ///< [m], of `crossing`, where words turn the tool
  std::vector<double> turn_units{};  ///< [rad] of 1, of each turning word
  char extruder_letter = 'E';
  /// Commands that switch to `tip` and to `machine`.
  std::vector<std::string> tip_control_on{"G43.4"}, tip_control_off{"G49"};

  /// What a program of tips and tool axes has to begin with.
  std::vector<std::string> commands_for_tips() const {
    if (coordinates == "tip" || tip_control_on.empty()) return {};
    return {tip_control_on.front()};
  }
};

}  // namespace understudy::machine

// SAVE_GCODE_STATE and RESTORE_GCODE_STATE, as Klipper has them ("G-Codes", gcode_move).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace understudy::toolpath {

struct SavedStateCall {
  bool save = true;  ///< false: restore
  std::string name;
  bool back = false;            ///< MOVE=1
  std::optional<double> speed;  ///< [m/s], MOVE_SPEED
};

/// SAVE_GCODE_STATE [NAME=a], RESTORE_GCODE_STATE [NAME=a] [MOVE=1 [MOVE_SPEED=mm/s]]; of other lines none.
/// Throws InputError at `place`.
std::optional<SavedStateCall> saved_state_call(std::string_view line, const Place& place);

}  // namespace understudy::toolpath

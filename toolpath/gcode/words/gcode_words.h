// The words of the dialect: commands, and what slicers and firmwares write that the twin has no use for.
#pragma once

#include <string>
#include <string_view>

namespace understudy::toolpath {

/// What G and M words the dialect knows.
enum class Command {
  rapid,                 // G0
  linear,                // G1
  clockwise_arc,         // G2
  counterclockwise_arc,  // G3
  dwell,                 // G4
  spline,                // G5
  retract,               // G10
  unretract,             // G11
  plane_xy,              // G17
  plane_zx,              // G18
  plane_yz,              // G19
  inches,                // G20
  millimetres,           // G21
  home,                  // G28
  tip_coordinates,       // G43.4
  machine_coordinates,   // G49
  machine_position,      // G53
  work_offset,           // G54 to G59.3
  absolute,              // G90
  relative,              // G91
  set_position,          // G92
  inverse_time,          // G93
  per_minute,            // G94
  tool_change,           // M6
  absolute_extrusion,    // M82
  relative_extrusion,    // M83
  heat,                  // M104
  heat_and_wait,         // M109
  fan_on,                // M106
  fan_off,               // M107
  acceleration,          // M204
  retraction,            // M207
  speed,                 // M220
  flow,                  // M221
  end,                   // M2, M30
};

/// Commands of one group exclude each other on a line (the modal groups of RS-274, and the S word's users).
enum class Group {
  motion,
  plane,
  units,
  coordinates,
  machine_position,
  work_offset,
  distance,
  feed_mode,
  extrusion,
  process,
  end
};

struct Meaning {
  char letter;
  double number;
  Command command;
  Group group;
};
/// Null: no such command.
const Meaning* meaning_of(char letter, double number);
Group group_of(Command command);

/// A command without effect on the twin, which stands alone on its line: limits are the machine
/// description's, there is no heated bed, no display, and motors stay on.
struct WithoutEffect {
  char letter;
  double number;
  const char* parameters;  ///< that a G may have; an M, which firmwares read as they like, may have any
  /// Whether it may share its line with other commands: those that need no parameters.
  constexpr bool combines() const {
    return *parameters == 0 || (letter == 'G' && (number == 64 || number == 80));
  }
};
/// Null: it has an effect, or is not known.
const WithoutEffect* without_effect(char letter, double number);

/// Whether the line is one of those that are no row of letters and numbers and have no effect: a `%`, the
/// number of a program (O1000), a text for a display (M117, M118, M1002) or a name for a part (M486), a
/// firmware's command in words such as EXCLUDE_OBJECT_START.
bool is_line_without_effect(std::string_view line);

/// The first word of a line that is a firmware's command in words (two letters or more), upper case; empty
/// where it is none.
std::string command_in_words(std::string_view line);

}  // namespace understudy::toolpath

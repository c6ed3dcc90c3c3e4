// How a user says that a program of another machine is to be read, as plain data.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace understudy::control {

/// How a robot's program, KRL or RAPID, is read (docs/robot-programs.md).
struct RobotProgramRequest {
  std::vector<std::string> signals;      ///< outputs that feed filament; empty: those that the program sets
  std::array<double, 2> bead_mm{0, 0};   ///< width and height of what a signal above 0 lays; 0: not told
  std::optional<double> flow_mm3_per_s;  ///< that a signal of 1 feeds
  std::string tool_points;  ///< axis of its tool out of the nozzle: z, -x...; empty: told by the path
};

/// How a program of another machine is read (docs/gcode.md).
struct DialectRequest {
  std::array<double, 3> place_mm{0, 0, 0};  ///< where the program's origin stands in W
  bool place_auto = false;                  ///< the place is found before, `place_mm` unused
  /// The program turned about z of W through its origin, and the tool about its own axis besides
  /// (toolpath/gcode/rewrite/turned_program.h).
  double turn_deg = 0, spin_deg = 0;
  std::string extruder_letter;          ///< E, A...; empty: the machine's
  bool relative_extrusion = false;      ///< E counts on from the start, as after M83
  int b_sign = 1, c_sign = 1;           ///< -1: the program counts that axis the other way round
  std::vector<std::string> ignored;     ///< commands passed over with their lines, upper case
  std::string macros;                   ///< path of a Klipper configuration; empty: none
  std::optional<double> temperature_c;  ///< of the nozzle from the start on
  std::optional<double> nozzle_mm;      ///< bore that is mounted in place of the machine file's
  std::optional<double> layer_mm;       ///< height of layers where the program's path does not tell
  bool strict = false;      ///< lines that cannot be read or carried out are refused, not passed over
  std::string coordinates;  ///< of rotary programs: tip, machine, crossing; empty: the machine's
  RobotProgramRequest robot;
};

}  // namespace understudy::control

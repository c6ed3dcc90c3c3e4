// G-code as printers use it, with tool orientation per point (docs/gcode.md).
//
// Words: G0 G1 G4 G20 G21 G28 G90 G91 G92 G93 G94, M82 M83 M104 M109 M106 M107 M30, modal, with ; and ( )
// comments, E for filament length. Orientation: W I J K, a unit quaternion w + xi + yj + zk, or I J K alone,
// the tool axis. Lengths mm (or inch under G20), feeds mm/min.
#pragma once

#include <filesystem>
#include <string>

#include "toolpath/program.h"

namespace understudy::toolpath {

struct GcodeOptions {
  Pose X_WT_home = Pose::Identity();
  double unit_tolerance = 1e-4;   ///< a quaternion or axis farther than this from length 1 is an error
};

/// Throws InputError with file, line and column for an unknown word, a malformed or non-finite number, a
/// quaternion or axis that is not of unit length, a G1 before any feed, a file without any move.
Program read_gcode(const std::filesystem::path& path, const GcodeOptions& options);
Program parse_gcode(const std::string& text, const std::string& file, const GcodeOptions& options);

/// Text that read_gcode turns into the same program. `header` lines become comments at the top.
std::string write_gcode(const Program& program, const std::vector<std::string>& header);

}  // namespace understudy::toolpath

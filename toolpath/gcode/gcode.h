// G-code as printers use it, with tool orientation per point (docs/gcode.md).
//
// Words: G0 to G5, G10 G11 G17 to G21 G28 G53 to G59.3 G90 to G94, M2 M6 M30 M82 M83 M104 M106 M107 M109 M207
// M220 M221 and T, modal, with ; and ( ) comments, E for filament length; what slicers write beside it and
// the twin has no use for is a list (gcode_words.cpp). Orientation: W I J K, a unit quaternion w + xi + yj +
// zk, or I J K alone, the tool axis; or the letters of turning axes of a machine that has them, with G43.4
// and G49. Lengths mm (or inch under G20), angles degrees, feeds mm/min.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "toolpath/arc_chords.h"
#include "toolpath/gcode/gcode_extrusion.h"
#include "toolpath/gcode/gcode_refused.h"
#include "toolpath/gcode/macros/gcode_macros.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

constexpr double kLargestCoordinate = 100;  ///< [m], that is read or written

/// What the one or two rotary words mean on a machine that has them; b and c are the first and the second,
/// c is 0 where there is one. Angles in [rad], of any number of turns.
struct RotaryWords {
  enum class Coordinates {
    tip,      ///< X Y Z is p_WT (tool-centre-point coordinates, G43.4)
    machine,  ///< X Y Z are the slides (G49)
    /// X Y Z are the slides of some machine whose turning axes cross at the program's origin:
    /// p_WT = offset_W + crossing(B, C) (X, Y, Z). No word of the program says so.
    crossing,
  };
  Coordinates coordinates = Coordinates::tip;  ///< before the program says which
  std::string letters = "BC";                  ///< of both, out of kRotaryLetters
  double b_unit = kDegree, c_unit = kDegree;   ///< [rad] of 1 in the program
  double b_home = 0, c_home = 0;               ///< at X_WT_home
  /// Commands that switch to `tip` and to `machine`, upper case.
  std::vector<std::string> tip_commands{"G43.4"}, machine_commands{"G49"};
  /// X_WT of a tip at p_WT.
  std::function<Pose(const Vec3& p_WT, double b, double c)> tip_pose;
  /// X_WT of slides at X Y Z [m]; without it there are no machine coordinates.
  std::function<Pose(const Vec3& slides, double b, double c)> slides_pose;
  /// The slides [m] that hold the tip at p_WT.
  std::function<Vec3(const Vec3& p_WT, double b, double c)> slides;
  /// From X Y Z of `crossing` to the tip; without it the rotation of tip_pose.
  std::function<Pose(double b, double c)> crossing;
};
constexpr const char* kRotaryLetters = "ABCDUVW";  ///< that may turn an axis, or feed filament

/// A word that the dialect does not know, and the lines that have it.
struct UnknownWordCount {
  std::string word;
  int lines = 0, first_line = 0;
};

/// A line that cannot be read, and is left out with the moves after it that begin at a place which it alone
/// says.
struct PassedOver {
  int line = 0, column = 0;
  int last_line = 0;  ///< that is left out
  std::string why;
  std::string unknown;  ///< letters whose numbers had to be said again: X Y Z, B C, E, W of orientation
  double filament = 0;  ///< [m], that these lines would have laid
  bool filament_known = true;  ///< false: and more, which cannot be read
};
constexpr int kMostPassedOver = 20;  ///< lines of one program; with more it is refused

struct GcodeOptions {
  Pose X_WT_home = Pose::Identity();  ///< where the tool starts and where G28 takes it
  double unit_tolerance = 1e-4;       ///< a quaternion or axis farther than this from length 1 is an error
  std::optional<RotaryWords> rotary = std::nullopt;  ///< without it A, B and C are errors
  /// [m/s], by which the tip's velocity may change between two chords of an arc before the controller brakes
  /// there: its chords are short enough for that, but for a floor of 0.05 mm.
  double corner_velocity_change = std::numeric_limits<double>::infinity();
  std::size_t chords_max = kMostChords;  ///< of all arcs and splines; a program with more is refused
  // Of the dialect.
  char extruder_letter = 'E';       ///< of filament: E, or a rotary letter that turns nothing
  bool relative_extrusion = false;  ///< E counts on from the start, as after M83
  Vec3 offset_W{0, 0, 0};           ///< [m], the program's origin in W
  int b_sign = 1, c_sign = 1;       ///< -1: the program counts that axis the other way round
  /// Commands to pass over with their lines, upper case: "M428", "START_PRINT".
  std::vector<std::string> ignored = {};
  /// [K], to which those of them that are words heat a nozzle which nothing has heated before the first bead.
  std::optional<double> ignored_heat = std::nullopt;
  /// What commands that are unknown here stand for; null: nothing.
  std::shared_ptr<const GcodeMacros> macros = nullptr;
  /// Where unknown words are counted, whose lines are then passed over; null: they are errors. Not owned.
  std::vector<UnknownWordCount>* unknown = nullptr;
  /// Where lines that cannot be read are told, which are then passed over (docs/gcode.md); null: they are
  /// errors. Not owned.
  std::vector<PassedOver>* passed_over = nullptr;
  /// Where all other lines that are refused are told, which are then left out; null: they are errors, with
  /// `passed_over` all in one at the program's end. Not owned.
  RefusedLines* refused = nullptr;
  /// Where moves are counted that feed filament by absolute E; null: nowhere. Not owned.
  ExtrusionTally* extrusion = nullptr;
};

/// Throws InputError with file, line and column for unknown words (all of the file's in one), a malformed or
/// non-finite number, a quaternion or axis that is not of unit length, a G1 before any feed, a file without
/// any move. Extrusion that does not move the tip has no path to run a feed along: its step carries
/// `duration` = |E| / F instead.
Program read_gcode(const std::filesystem::path& path, const GcodeOptions& options);
Program parse_gcode(const std::string& text, const std::string& file, const GcodeOptions& options);

/// Throws InputError that tells all of these lines, of which there is one at least.
[[noreturn]] void refuse_passed_over(const std::string& file, const std::vector<PassedOver>& lines);

/// How a machine wants its programs written.
struct GcodeStyle {
  char extruder_letter = 'E';
  std::vector<std::string> commands = {};  ///< before the first step, such as "G43.4"
  /// Steps with turns state the tool's orientation by these letters, up to two, in place of W I J K; each
  /// with its unit [rad].
  std::string turn_letters = {};
  std::vector<double> turn_units = {};
};

/// Text that read_gcode turns into the same program: lengths within 0.5e-6 mm, quaternion components within
/// 0.5e-9, orientation within 2e-9 rad, or turns within 0.5e-6 of their unit. Without `turn_letters`, turning
/// axes are left out: the poses say where the tool goes, not by which turns of the table. `header` lines
/// become comments at the top. Throws InputError for a step that G-code cannot say: a print or move without
/// feed, a value not finite.
std::string write_gcode(const Program& program, const std::vector<std::string>& header,
                        const GcodeStyle& style = {});

}  // namespace understudy::toolpath

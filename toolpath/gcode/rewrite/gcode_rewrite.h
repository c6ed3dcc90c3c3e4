// A program whose moves go elsewhere, with all else as it was: comments, words that are passed over, lines.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {

/// Where a piece of a line's way ends instead.
struct MovedPiece {
  Pose X_WT = Pose::Identity();
  std::optional<RotaryTurns> rotary = std::nullopt;  ///< where the line states turning axes
  double share = 1;  ///< of the line's way, filament and time that is done there; the last has 1
};
/// By number of the line, from 1.
using MovedLines = std::map<int, std::vector<MovedPiece>>;

/// Numbers of the lines whose moves rewrite_gcode() can place elsewhere: those whose own words say where the
/// tool goes. Homing and what macros do are none. Throws InputError as parse_gcode() does.
std::vector<int> lines_that_place(const std::string& text, const std::string& file,
                                  const GcodeOptions& options);

/// `text` with the words X Y Z, of orientation or turning axes, E, and under G93 F, of the lines in `moved`
/// set anew. A line of several pieces goes on in lines of its own, which end in the comment of
/// continuation_comment(); arcs and splines become G1. Lengths have 1e-6 mm (or inch), quaternions 1e-9. The
/// reading of each line is checked by the reader itself, so rounding does not add up. Throws InputError with
/// the place in `text` for a line that cannot say its pose.
std::string rewrite_gcode(const std::string& text, const std::string& file, const GcodeOptions& options,
                          const MovedLines& moved);

/// "; 2/5 of line 13"
std::string continuation_comment(std::size_t piece, std::size_t pieces, int line);
/// Whether a line of a rewritten program goes on with the one before.
bool is_continuation(std::string_view line);

/// What a rewritten program was made of.
struct ProgramOrigin {
  std::string file;    ///< as its user named it
  std::string sha256;  ///< of its bytes
};
/// The last line of such a program, a comment: "; compensated from line.gcode, sha256 ab12..."
std::string origin_comment(const ProgramOrigin& origin);
std::optional<ProgramOrigin> origin_of(std::string_view text);

}  // namespace understudy::toolpath

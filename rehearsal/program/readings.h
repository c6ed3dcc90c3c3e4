// How a program's rotary words may be read, and whether the reading in use is the one that its path shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rehearsal/findings/finding.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/inspection/reading_quality.h"

namespace understudy::rehearsal {

/// One way to read a program's rotary words (docs/gcode.md).
struct RotaryReading {
  std::string coordinates;  ///< as set_coordinates() takes it
  int b_sign = 1, c_sign = 1;
  toolpath::ReadingQuality quality;
  double floating = 0;  ///< toolpath::floating_share()
};

struct ProgramText {
  std::string name, text;
};

/// `options` of the machine, with rotary words; those of the reading in place of theirs.
toolpath::GcodeOptions read_as(const RotaryReading& reading, const toolpath::GcodeOptions& options);

/// Every reading that the program allows, the most likely first: by how far the printed path leaves the plane
/// across the tool, by the longest printed step, by how even the beads are, and by how much begins in the air
/// (the product of the four). Readings for machines whose head tilts have the pivot, within half a metre,
/// that makes the beads most even. Throws InputError where no reading is possible.
std::vector<RotaryReading> rank_readings(const ProgramText& program, const toolpath::GcodeOptions& options);

/// A finding where the printed path of `read`, which was parsed with `options`, disagrees with the tool's
/// axis and another reading agrees: the program was written for another kind of machine.
std::optional<Finding> misread_words(const toolpath::Program& read, const ProgramText& program,
                                     const toolpath::GcodeOptions& options, const std::string& machine);

}  // namespace understudy::rehearsal

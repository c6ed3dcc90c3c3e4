// How a family of controllers wants its blocks written, and which letters its axes have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "drivers/gcode/block_fitter.h"
#include "drivers/port_uri.h"
#include "machine/description.h"

namespace understudy::drivers {

enum class GcodeFamily { grblhal, marlin, reprapfirmware, linuxcnc };
const char* to_string(GcodeFamily family);
/// Throws InputError for another word, naming the nearest family.
GcodeFamily gcode_family(const std::string& word);

/// Letters and units of a machine's axes on a controller. In files and on the line: mm and degrees.
struct GcodeAxes {
  std::string letters;      ///< one an axis, in the machine's order
  char extruder = 'E';      ///< 0: the controller feeds no filament
  std::vector<bool> turns;  ///< of each axis
  BlockGrid grid;           ///< of the numbers that are written

  int count() const { return static_cast<int>(letters.size()); }
  double unit(int axis) const;  ///< [m or rad] of 1
};

/// Of the options `axes` and `extruder` of a URI, else those that the family has for such axes: slides X Y Z
/// and what follows, turns A B C. Throws InputError for letters that do not fit.
GcodeAxes gcode_axes(GcodeFamily family, const machine::MachineDescription& machine, const PortUri& options);

/// Writes blocks one after the other: words that did not change are left out.
class GcodeWriter {
 public:
  GcodeWriter(GcodeFamily family, GcodeAxes axes);

  /// Lines before the first block: units, absolute, feed mode.
  std::vector<std::string> preamble() const;
  /// From here the next block starts.
  void begin(const PathSample& at);
  /// One line; of a block that rests a dwell.
  std::string block(const Block& block);
  /// Lines of new outputs; heating waits where it is for more heat.
  std::vector<std::string> outputs(const machine::Outputs& before, const machine::Outputs& after) const;

  const GcodeAxes& axes() const { return axes_; }
  GcodeFamily family() const { return family_; }

 private:
  double feed_length(const Block& block) const;

  GcodeFamily family_;
  GcodeAxes axes_;
  Block last_;
};

}  // namespace understudy::drivers

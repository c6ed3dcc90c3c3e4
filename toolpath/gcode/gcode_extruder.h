// The extruder of a G-code program: what its E reads, what it has fed, and how it retracts.
#pragma once

#include <optional>

#include "core/units.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

/// Filament that goes through it at rest, back where it is negative.
struct FedAtRest {
  double filament = 0;  ///< [m]
  double duration = 0;  ///< [s]
};

/// Members that take a line throw InputError with place. `unit` [m] is that of the line's lengths.
class GcodeExtruder {
 public:
  explicit GcodeExtruder(bool relative) : relative_(relative) {}

  bool relative() const { return relative_; }  ///< E counts on, by M83
  void set_relative(bool relative) { relative_ = relative; }
  double reading() const { return reading_; }  ///< [m], of E
  void set_flow(double share) { flow_ = share; }
  /// What Klipper's states keep of it: reading, flow and the reading of E.
  void take_saved(const GcodeExtruder& saved);

  /// E of a move: filament that it feeds [m]. `counts_on`: by M83, or as every axis under G91.
  double feed(Block& block, double unit, bool counts_on);
  /// E of G92.
  void rename(Block& block, double unit);
  /// M207: what the firmware does at G10.
  void set_retraction(Block& block, double unit);
  /// G10 and G11 as firmwares have them, by the length of M207.
  FedAtRest retract(Block& block);
  /// T alone, or with what concerns one tool. Machines here have one extruder; whether a program calls it T0
  /// or T1 is its own affair, as long as it keeps to one.
  void select(Block& block);

  double most_fed() const { return most_fed_; }           ///< [m] of filament, since the beginning
  double drawn_back() const { return most_fed_ - fed_; }  ///< [m] of filament
  const ExtrusionTally& tally() const { return tally_; }

 private:
  void count_absolute(int line, double value, double before, bool fresh);
  double count_fed(double filament);

  double reading_ = 0;             // [m]
  double fed_ = 0, most_fed_ = 0;  // [m]
  ExtrusionTally tally_;
  double flow_ = 1;  // filament fed for one that is programmed (M221)
  bool relative_;
  std::optional<double> retraction_;  // [m], of G10 (M207)
  double retraction_feed_ = 0;        // [m/s]
  bool retracted_ = false;            // by G10
  std::optional<double> tool_;        // number of the only extruder, once a line has said it
};

}  // namespace understudy::toolpath

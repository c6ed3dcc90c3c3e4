// What earlier lines of a G-code program left behind, and what one more line makes of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_extruder.h"
#include "toolpath/gcode/gcode_position.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

class GcodeState {
 public:
  explicit GcodeState(const GcodeOptions& options);

  /// Runs a line and appends its steps. In the order of RS-274: units and modes, feed, heater and fan,
  /// motion, end. Throws InputError with place.
  void run(Block& block, std::vector<Step>& steps);

  /// Klipper's SAVE_GCODE_STATE: modes, feed, percentages, shifts, reading of E and place, by a name.
  void save(const std::string& name);
  /// RESTORE_GCODE_STATE: brings all of that back but the place. `back` goes there, at `speed` [m/s] or at
  /// the saved feed. Throws InputError at `place` for a name that was not saved.
  void restore(const std::string& name, bool back, const std::optional<double>& speed, const Place& place,
               std::vector<Step>& steps);

  // For lines that are written anew (gcode_rewrite.h).

  const GcodePosition& position() const { return position_; }
  /// As GcodePosition::reading_at, in the units and modes in force.
  PlaceReading reading_at(const Pose& X_WT, const std::optional<RotaryTurns>& turns, bool in_machine) const {
    return position_.reading_at(X_WT, turns, unit_, relative_, in_machine);
  }
  double extruder_reading() const { return extruder_.reading() / unit_; }  ///< of E, in the units in force
  bool inverse_time() const { return inverse_time_; }
  bool on_curve() const { return is_curve(); }  ///< the motion in force is G2, G3 or G5

  // For lines that are passed over (gcode_passed_over.h).

  const Pose& X_WT() const { return position_.X_WT(); }
  bool relative() const { return relative_; }
  /// E counts on: by M83, and as every axis under G91 (Marlin, Klipper).
  bool relative_extrusion() const { return extruder_.relative() || relative_; }
  /// As if M83 had been read.
  void extrude_relative() { extruder_.set_relative(true); }
  bool ended() const { return ended_; }
  bool on_arc() const { return is_curve(); }
  const GcodeExtruder& extruder() const { return extruder_; }
  /// What a move that is passed over says of the motion and the feed of later lines.
  void take_modes(Block& block);
  /// And of where they begin and what E reads there. Throws InputError with place.
  void take_end(Block& block);
  /// The steps from a tool at `from` to where it is now, without a bead: a travel, and `filament` [m] that is
  /// pushed back or drawn back at rest.
  void rejoin(const Pose& from, double filament, int line, std::vector<Step>& steps) const;

 private:
  enum class Motion { none, rapid, linear, clockwise_arc, counterclockwise_arc, spline };

  static void check_nothing_moves(const Block& block);
  void set_modes(const Block& block);
  void set_feed(Block& block);
  void set_process(Block& block, std::vector<Step>& steps);
  void run_motion(Block& block, std::vector<Step>& steps);
  void dwell(Block& block, std::vector<Step>& steps);
  void home(Block& block, std::vector<Step>& steps);
  void set_nozzle(Block& block, std::vector<Step>& steps);
  bool sets_tool(const Block& block) const;
  void set_fan(Block& block, std::vector<Step>& steps);
  std::optional<double> percent(Block& block, const char* what) const;
  void set_acceleration(Block& block);
  void retract(Block& block, std::vector<Step>& steps);
  void set_position(Block& block);
  void move(Block& block, std::vector<Step>& steps);
  void move_along_arc(Block& block, std::vector<Step>& steps);
  void move_along_spline(Block& block, std::vector<Step>& steps);
  void count_chords(const Block& block, std::size_t more);
  Step chord(Block& block);
  bool is_arc() const { return motion_ == Motion::clockwise_arc || motion_ == Motion::counterclockwise_arc; }
  bool is_curve() const { return is_arc() || motion_ == Motion::spline; }
  void set_pace(const Block& block, Step& step) const;
  double acceleration_of(const Step& step) const {
    return step.kind == StepKind::print ? acceleration_ : travel_acceleration_;
  }

  struct Saved {
    GcodePosition position;
    GcodeExtruder extruder;
    double speed;
    bool relative;
    std::optional<double> feed;
  };

  double fed_filament(Block& block) { return extruder_.feed(block, unit_, relative_extrusion()); }
  Step step(StepKind kind, int line) const;

  GcodePosition position_;
  GcodeExtruder extruder_;
  double corner_velocity_change_;            // [m/s]
  std::size_t chords_ = 0, chords_max_;      // of all curves so far
  double speed_ = 1;                         // of feeds, for what is programmed (M220)
  double acceleration_ = kUnlimited;         // [m/s^2], of moves that feed filament (M204)
  double travel_acceleration_ = kUnlimited;  // of the others
  int plane_normal_ = 2;                     // of arcs (G17, G18, G19)
  double unit_ = kMillimetre;                // [m]
  bool relative_ = false;
  bool inverse_time_ = false;
  Motion motion_ = Motion::none;
  std::optional<double> feed_;      // [m/s] under G94
  std::optional<double> duration_;  // [s] of this line's move under G93
  bool ended_ = false;
  std::map<std::string, Saved> saved_;
};

}  // namespace understudy::toolpath

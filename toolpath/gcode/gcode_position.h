// Where a G-code program has taken the tool: what its words X Y Z, B C and W I J K read and what pose they
// make.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolpath/gcode/curves/gcode_arc.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_work_offsets.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

/// What the words of a place read.
struct PlaceReading {
  Vec3 xyz{0, 0, 0};    ///< in units of the program
  RotaryTurns turns{};  ///< likewise, of the rotary words
};

/// [m] of a word in units of `unit` [m]. Throws InputError with place for one that no machine can mean.
double length_of(const Block& block, const Word& word, double unit);

class GcodePosition {
 public:
  explicit GcodePosition(const GcodeOptions& options);

  const Pose& X_WT() const { return X_WT_; }
  /// How the turning axes stand; nothing where the machine has none or the program does not say.
  const std::optional<RotaryTurns>& turns() const { return turns_; }
  /// What a line's words would have to read to bring the tool to X_WT, with the turning axes at `turns` where
  /// the program states those. `unit` [m]; `in_machine`: under G53.
  PlaceReading reading_at(const Pose& X_WT, const std::optional<RotaryTurns>& turns, double unit,
                          bool relative, bool in_machine) const;
  /// "B C ", for messages; empty where the machine has none.
  std::string rotary_letters() const;

  // All of these throw InputError with place.

  /// G43.4 and G49: what X Y Z mean from here on; the tool stays where it is.
  void set_coordinates(const Block& block);
  /// G28. False: the line names some of the axes, and these alone went there.
  bool go_home(Block& block);
  /// G92: the present position is called so from now on.
  void rename(Block& block, double unit);
  /// G54 to G59.3: which work offset counts from here on; the tool stays where it is.
  void select_work_offset(const Block& block);
  /// G10 L2 and L20.
  void set_work_offset(Block& block, double unit, bool relative);
  /// The shifts of G92 that were in force at `saved`.
  void take_shifts(const GcodePosition& saved);
  /// X Y Z where they were at `saved`. False: rotary words of the machine leave that open.
  bool go_back_to(const GcodePosition& saved);
  /// Position and orientation of a G0 or G1; with G53 in machine coordinates.
  void move(Block& block, double unit, bool relative);
  /// Position of a G2 or G3 in the plane across axis `normal`: where its chords end, in W; the orientation
  /// stays.
  std::vector<Vec3> move_along_arc(Block& block, double unit, bool relative, int normal, bool clockwise,
                                   double turn_max);
  /// Position of a G5, likewise, in the plane XY.
  std::vector<Vec3> move_along_spline(Block& block, double unit, bool relative);

 private:
  using Coordinates = RotaryWords::Coordinates;

  void go_home();
  void home_some(const Block& block);
  Vec3 shift() const;   // of the whole program in W
  Vec3 origin() const;  // origin_ without G92
  Vec3 programmed_at(const Pose& X_WT) const;
  Pose pose_at_programmed() const;
  Pose crossing() const;
  double turn_unit(int word) const;
  void refuse_two_orientations(const Block& block) const;
  void read_lengths(Block& block, double unit, bool relative);
  void refuse_turns_on_curve(const Block& block) const;
  void read_centre(Block& block, double unit, Arc& arc) const;
  bool read_turns(Block& block, bool relative);
  std::optional<Quat> read_orientation(Block& block) const;
  void require_turns(const Word& word, const Block& block, bool both_given) const;

  std::shared_ptr<const GcodeOptions> options_;  // positions are copied, these are large
  Pose X_WT_;                                    // where the tool is
  Coordinates coordinates_;
  Vec3 programmed_;             // [m], what X Y Z are a reading of: p_WT, or slides
  Vec3 origin_ = Vec3::Zero();  // [m], reading + origin = programmed (G54 to G59.3, G92)
  WorkOffsets work_;
  std::optional<RotaryTurns> turns_;  // of the axes; nothing after W I J K or I J K
  std::optional<Vec2> spline_end_;    // [m], from the end of the G5 just before, along its tangent
  RotaryTurns turns_origin_;          // reading + origin = turns (G92)
};

}  // namespace understudy::toolpath

// Where a G-code program has taken the tool: what its words X Y Z, B C and W I J K read and what pose they
// make.
#pragma once

#include <optional>

#include "toolpath/gcode.h"
#include "toolpath/gcode_block.h"

namespace understudy::toolpath {

/// [m] of a word in units of `unit` [m]. Throws InputError with place for one that no machine can mean.
double length_of(const Block& block, const Word& word, double unit);

class GcodePosition {
 public:
  explicit GcodePosition(const GcodeOptions& options);

  const Pose& X_WT() const { return X_WT_; }
  bool has_rotary_words() const { return options_.rotary.has_value(); }

  // All of these throw InputError with place.

  /// G43.4 and G49: what X Y Z mean from here on; the tool stays where it is.
  void set_coordinates(const Block& block);
  /// G28.
  void go_home();
  /// G92: the present position is called so from now on.
  void rename(Block& block, double unit);
  /// Position and orientation of a G0 or G1.
  void move(Block& block, double unit, bool relative);

 private:
  using Coordinates = RotaryWords::Coordinates;
  struct Turns {
    double b = 0, c = 0;  // [rad]
  };

  void refuse_two_orientations(const Block& block) const;
  void read_lengths(Block& block, double unit, bool relative);
  bool read_turns(Block& block, bool relative);
  std::optional<Quat> read_orientation(Block& block) const;
  void require_turns(const Word& word, const Block& block, bool both_given) const;

  GcodeOptions options_;
  Pose X_WT_;  // where the tool is
  Coordinates coordinates_;
  Vec3 programmed_;             // [m], p_WT or, in machine coordinates, the slides
  Vec3 origin_ = Vec3::Zero();  // [m], reading + origin = programmed (G92)
  std::optional<Turns> turns_;  // of the axes; nothing after W I J K or I J K
  Turns turns_origin_;          // reading + origin = turns (G92)
};

}  // namespace understudy::toolpath

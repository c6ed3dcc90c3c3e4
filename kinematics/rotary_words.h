// The words of a program that state single axes: how one or two are turned, such as B and C of a table that
// tilts and turns, and X Y Z where they are slides.
#pragma once

#include <cstddef>
#include <span>

#include "core/frames.h"

namespace understudy::kinematics {

struct AxisWord {
  char letter = 'B';
  std::size_t axis = 0;  ///< that it moves
  int sign = 1;          ///< -1: the word counts against the axis
  double home = 0;       ///< [rad] or [m], the word at home
  double zero = 0;       ///< [rad] or [m], the axis where the word is 0

  /// [rad] or [m], what the word reads at these axes, and the axis at a reading.
  double reading(std::span<const double> axes) const { return sign * (axes[axis] - zero); }
  double position(double reading) const { return zero + sign * reading; }
};

/// A point and the readings of the rotary words, in the order of Mechanism::rotary_words(); or their rates.
struct RotaryTarget {
  Vec3 p_BT{0, 0, 0};   ///< [m], the tip; of `pose_at_slides` the words X Y Z of the slides
  double b = 0, c = 0;  ///< [rad], the first and, where there is one, the second, of any number of turns
};

}  // namespace understudy::kinematics

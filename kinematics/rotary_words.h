// The words of a program that state how two axes are turned, such as B and C of a table that tilts and turns.
#pragma once

#include <cstddef>
#include <span>

#include "core/frames.h"

namespace understudy::kinematics {

struct RotaryWord {
  char letter = 'B';     ///< one of A, B, C
  std::size_t axis = 0;  ///< that it turns
  int sign = 1;          ///< -1: the word counts against the axis
  double home = 0;       ///< [rad], the word at home

  /// [rad], what the word reads at these axes.
  double reading(std::span<const double> axes) const { return sign * axes[axis]; }
};

/// A point and the readings of both rotary words, in the order of Mechanism::rotary_words(); or the rates of
/// both.
struct RotaryTarget {
  Vec3 p_BT{0, 0, 0};   ///< [m], the tip; of `pose_at_slides` the words X Y Z of the slides
  double b = 0, c = 0;  ///< [rad], the first and the second, of any number of turns
};

}  // namespace understudy::kinematics

// Into how many chords an arc is cut, and how many a program may ask for: three words may ask for more than
// any memory holds.
#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// Of one arc: a hundred turns with a radius of 0.4 m.
constexpr std::size_t kMostArcChords = 100'000;
/// Of all curves of a program: some kilometres of arcs.
constexpr std::size_t kMostChords = 10'000'000;

/// Of an arc.
struct Chords {
  double count = 1;        ///< a whole number, maybe beyond any integer
  std::vector<Vec3> ends;  ///< none where there are more than kMostArcChords
  bool too_many() const { return !(count <= static_cast<double>(kMostArcChords)); }
};

/// The longest chord [rad], at most a sixteenth of a turn, that keeps within `tolerance` [m] of a circle of
/// `radius` [m]: its sagitta is r (1 - cos(chord / 2)).
double chord_angle(double radius, double tolerance);
/// How many equal chords of at most `chord` [rad] a turn of `sweep` [rad] takes, at least 1.
double chord_count(double sweep, double chord);

}  // namespace understudy::toolpath

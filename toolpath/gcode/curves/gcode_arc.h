// G2 and G3: circles and helices as rows of chords.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "core/frames.h"
#include "toolpath/arc_chords.h"

namespace understudy::toolpath {

struct Arc {
  Vec3 from, to;               ///< [m], in the program's coordinates
  int normal = 2;              ///< the axis across its plane: 2 of G17, 1 of G18, 0 of G19
  bool clockwise = false;      ///< seen against that axis
  Vec3 centre = Vec3::Zero();  ///< [m]; its part along the normal is not used
  double turns = 1;            ///< P: a whole number, above 1 for full turns besides
};

/// The centre of an arc of radius `radius` [m], below 0 for the longer way round (RS-274). Nothing where
/// there is none: the ends are one point, or farther apart than two radii.
std::optional<Vec3> arc_centre(const Arc& arc, double radius);

/// By how much the distances of both ends from the centre differ [m], where that is more than rounding in a
/// file explains; else nothing.
std::optional<double> arc_mismatch(const Arc& arc);

/// What chords keep to.
struct ChordLimits {
  double tolerance = 0;                                   ///< [m], from the arc
  double turn = std::numeric_limits<double>::infinity();  ///< [rad], from one to the next
  double shortest = 0;                                    ///< [m], whatever the turn
};

/// The ends of chords; the last is `to`. The radius runs linearly from that of `from` to that of `to`, as
/// does the way along the normal. Ends that agree in the plane make a whole turn.
Chords arc_chords(const Arc& arc, const ChordLimits& limits);

}  // namespace understudy::toolpath

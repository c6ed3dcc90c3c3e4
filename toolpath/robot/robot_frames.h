// Private to this folder: orientations as the two languages state them, and arcs through three points.
#pragma once

#include <array>
#include <optional>

#include "core/frames.h"
#include "toolpath/arc_chords.h"

namespace understudy::toolpath {

/// KRL: first A about z, then B about the new y, then C about the new x. [rad]
Mat3 rotation_abc(double a, double b, double c);
/// Its inverse; B within [-pi/2, pi/2], and C = 0 where A and C turn about one axis.
Vec3 abc_of(const Mat3& R);

/// The ends of chords no farther than `tolerance` [m] from the circle through three points, with equal shares
/// of the turn; the last is `end` unless `angle` [rad] says how far it goes from `start` towards `via` (any
/// number of turns; below 0: the other way round). Nothing where the points lie on a line or agree.
std::optional<Chords> arc_through(const std::array<Vec3, 3>& start_via_end, std::optional<double> angle,
                                  double tolerance);

}  // namespace understudy::toolpath

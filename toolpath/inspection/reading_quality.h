// How much like a print a reading of a program's rotary words looks.
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

struct ReadingQuality {
  int moves = 0;            ///< that print, and that the angle is told from: where the tool leans, if it does
  double longest_step = 0;  ///< [m], of one move that prints: a wrong reading tears the path
  /// [rad], median of the angle by which the path leaves the plane across the tool's axis: a print runs along
  /// its layer, and the tool stands on it.
  double out_of_layer = 0;
  /// How much the beads differ, where the tool leans, if it does: the 90th percentile of filament over path,
  /// in the 10th. A wrong reading stretches some moves and shrinks others. 1 where no filament is told.
  double bead_spread = 1;
  double filament_share = 0;  ///< median of filament over path, both in m
};

/// `start_W` [m]: the tip before the first step.
ReadingQuality reading_quality(const Program& program, const Vec3& start_W);

}  // namespace understudy::toolpath

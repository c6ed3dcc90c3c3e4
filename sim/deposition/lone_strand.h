// Whether what lies below the tip is a strand that stands alone in air.
#pragma once

#include "sim/deposition/workpiece.h"

namespace understudy::sim {

/// [m]: the width of the strand in air that is `below`, as Workpiece::below() found it at X_WT; infinity
/// where there is material as high on both sides of it, a floor of strands. Nothing can be pressed wider than
/// what carries it: beside a lone strand there is nothing that the nozzle could press against.
double carrier_width(const Workpiece& workpiece, const Pose& X_WT, const Workpiece::Hit& below,
                     std::size_t before);

}  // namespace understudy::sim

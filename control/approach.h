// Which steps of a program are approaches: the straight way S'S to where a bead begins (Song 2015, 3.3).
#pragma once

#include "toolpath/program.h"

namespace understudy::control {

constexpr double kApproachLengthMax = 10e-3;  ///< [m]
constexpr double kApproachAngleMax =
    0.01745;  ///< [rad], between the way and the tool axis, and of any turn on it

/// Step `index` moves without extrusion, at most kApproachLengthMax, straight against its tool axis without
/// turning, and the next step that moves prints.
bool is_approach(const toolpath::Program& program, std::size_t index);

/// Where the tool is before step `index`: the end of the last step that moved, or `start`.
Pose pose_before(const toolpath::Program& program, std::size_t index, const Pose& start);

}  // namespace understudy::control

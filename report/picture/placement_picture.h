// The picture of `understudy place`: the margin over the table.
#pragma once

#include <string>

#include "rehearsal/placement/placement.h"
#include "renderer/scene_view.h"

namespace understudy::report {

/// Each cell has the margin with the middle of the print there: green, darker for more; red where a limit is
/// broken. The cross is the answer. `title` is "part.gcode on corexy".
renderer::Picture placement_picture(const rehearsal::Placement& placement, const std::string& title);

}  // namespace understudy::report

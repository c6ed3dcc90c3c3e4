// Beads as pictures draw them.
#pragma once

#include "renderer/scene_view.h"
#include "sim/surface/swept_shell.h"

namespace understudy::report {

/// In the colour of filament, where it was laid.
renderer::SmoothSurface bead_surface(sim::SweptShell shells);

}  // namespace understudy::report

// workspace.png.
#pragma once

#include "renderer/scene_view.h"
#include "studies/workspace/workspace_study.h"

namespace understudy::report {

/// The set in space, and slices of it. Throws MachineError when no OSMesa context can be made.
renderer::Picture workspace_picture(const studies::WorkspaceStudy& study);

}  // namespace understudy::report

// A program, and the part it was made for, where the part really stands.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "toolpath/program.h"

namespace understudy::control {

/// Every pose X_WT becomes X_W * X_WT, but for home and what stays there. A step that names its turning axes
/// keeps them: its tip moves with the part, and the tool leans by the part's turn less.
toolpath::Program moved_program(const toolpath::Program& program, const Pose& X_W);

std::shared_ptr<const geometry::Mesh> moved_part(const geometry::Mesh& part, const Pose& X_W);

}  // namespace understudy::control

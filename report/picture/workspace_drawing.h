// The parts of workspace.png: colours, the surface of the set, its view in space.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "renderer/scene_view.h"
#include "studies/workspace/workspace_study.h"

namespace understudy::report {

using Rgb = std::array<std::uint8_t, 3>;

/// Of the limit family with this rank; families beyond the palette share its last colour.
Rgb limit_colour(int family);
constexpr int kLimitColours = 8;
/// Of a reachable point: pale at the end of an axis, deep where every axis is mid-range.
Rgb margin_colour(double margin);

/// A part of the surface of the reachable set [m], in W: where one limit ends it, or the grid.
struct WorkspaceSurface {
  int family = -1;  ///< index into Workspace::families; -1: the edge of the grid
  std::shared_ptr<const geometry::Mesh> mesh;
};
/// Between reachable and other points, drawn as a smooth net (naive surface nets, Gibson 1998). Grids above
/// `cells_max` cells along an axis are thinned.
std::vector<WorkspaceSurface> workspace_surface(const kinematics::Workspace& workspace, int cells_max);

/// The set above the machine's table, and where points of W appear in that picture.
struct WorkspaceView {
  renderer::Picture picture;
  std::array<Vec2, 3> axis_label_px;  ///< beside the three edges of the box, x y z
};
WorkspaceView view_workspace(const studies::WorkspaceStudy& study, int width, int height);

}  // namespace understudy::report

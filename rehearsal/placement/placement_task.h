// What the search for a place has to do with: a machine, its table, a path and what else stands there.
#pragma once

#include <memory>
#include <utility>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "rehearsal/placement/path_poses.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// [m], in W, seen from above.
struct Area {
  Vec2 lower{0, 0}, upper{0, 0};
};

struct PlacementTask {
  machine::MachineDescription machine;             ///< standing at home as the request says
  ProgramPath path;                                ///< as high as the request says, or lifted onto the table
  Area area;                                       ///< of the table
  std::shared_ptr<const geometry::Mesh> obstacle;  ///< the fixture; null: none
};

/// Throws InputError as a rehearsal of the request would, and for a program that cannot be moved.
PlacementTask read_placement_task(const RehearsalRequest& request);

/// Columns and rows of a grid over it with `longer` points along the longer side, at least two.
std::pair<int, int> grid_size(const Area& area, int longer);

/// [mm], to what a place is told in: a micrometre.
double told_mm(double length);

}  // namespace understudy::rehearsal

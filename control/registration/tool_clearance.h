// How near the tool's bodies come to points of the part: what the controller itself can tell before it goes
// there.
#pragma once

#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"

namespace understudy::control {

/// [m] from a point to a body, both in the body's owner's frame; negative inside.
double distance_to(const geometry::Shape& body, const Vec3& p);

/// Points that cover a mesh: at most about `spacing` [m] apart, the same for equal arguments.
std::vector<Vec3> cover(const geometry::Mesh& mesh, double spacing);

/// Least distance [m] of the tool's bodies at X_WT to those points that are farther than `beyond` [m] from
/// the tip, and to the table's top at z = 0.
double tool_clearance(const machine::MachineDescription& machine, const std::vector<Vec3>& points_W,
                      const Pose& X_WT, double beyond);

}  // namespace understudy::control

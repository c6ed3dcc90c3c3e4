// Distance of a convex solid that lies over a face of a box, such as a nozzle over a table.
#pragma once

#include <optional>

#include "sim/distance/convex_solid.h"
#include "sim/distance/hull_core.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

/// Where the solid's point nearest to the plane of a face has its foot in that face, the plane between the
/// two tells their distance: no two points of them are nearer. Nothing where it has not, or where they
/// overlap. The solid at X_BS in the box's frame, which has `half` [m] to each side; the place is in that
/// frame.
std::optional<Separation> distance_over_face(const ConvexSolid& solid, const Pose& X_BS, const Vec3& half);
std::optional<Separation> distance_over_face(const HullCore& solid, const Pose& X_BS, const Vec3& half);

}  // namespace understudy::sim

// How far below the tip, along the tool axis, there is something to print on.
#pragma once

#include "core/frames.h"
#include "geometry/mesh.h"
#include "geometry/table_surface.h"

namespace understudy::sim {

constexpr double kGapReach = 50e-3;  ///< [m], below the tip: beyond it there is nothing to print on

/// Gap along the tool axis, from the tip to a surface: negative inside, infinity where the axis does not meet
/// it within kGapReach, minus infinity for a point behind an open mesh.
struct SurfaceGap {
  double gap;  ///< [m]
  Vec3 normal_W{0, 0, 1};
};
SurfaceGap table_gap(const geometry::TableSurface& table, const Vec3& tip_W, const Vec3& axis_W);
/// To a fixed mesh in W. A roof of the part above the tip is no surface to print on and does not count.
SurfaceGap part_gap(const geometry::Mesh& part, const Vec3& tip_W, const Vec3& axis_W);

}  // namespace understudy::sim

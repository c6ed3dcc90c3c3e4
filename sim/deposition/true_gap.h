// How far below the tip, along the tool axis, there is something to print on.
#pragma once

#include "core/frames.h"
#include "geometry/mesh.h"

namespace understudy::sim {

constexpr double kGapReach = 50e-3;  ///< [m], below the tip: beyond it there is nothing to print on

/// True gap along the tool axis: from the tip to the part or the table (the plane z = 0 of W), negative
/// inside. Infinity where the axis meets neither within kGapReach. A roof of the part above the tip is no
/// surface to print on and does not count.
double true_gap(const geometry::Mesh* part, const Pose& X_WT);

/// The same for one body, from any point along any axis; minus infinity for a point behind an open mesh.
struct SurfaceGap {
  double gap;  ///< [m]
  Vec3 normal_W{0, 0, 1};
};
SurfaceGap table_gap(const Vec3& tip_W, const Vec3& axis_W);
SurfaceGap part_gap(const geometry::Mesh& part, const Vec3& tip_W, const Vec3& axis_W);

}  // namespace understudy::sim

// The nominal part near the tool axis, as a quadric: what the dot's reading is inverted with.
#pragma once

#include <optional>

#include "core/frames.h"
#include "geometry/mesh.h"

namespace understudy::control {

/// The surface near the tool axis, in T with the tip at gap 0 on it:
///   z = slope . (x, y) + 1/2 (x, y) curvature (x, y)^T      (z along the tool axis, away from the part)
struct LocalSurface {
  Vec2 slope{0, 0};
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();  ///< [1/m], negative where the part bulges to the tool
};

/// Around the point under the tool [m]: the dot of every gap on the way down lies inside.
constexpr double kSurfaceRadius = 2.5e-3;

/// Makes what the first look would make otherwise: the search tree of a large part takes a second.
void make_ready(const geometry::Mesh& part);

/// Quadratic fit of the nominal part around the point under the tool, within kSurfaceRadius. The part is in
/// the frame of X_WT. Throws InputError when the axis does not meet the part within 20 mm of the tip, or when
/// the part ends or is not smooth there.
LocalSurface local_surface(const geometry::Mesh& part, const Pose& X_WT);

/// The same in a control cycle: nothing instead of an error. Does not allocate once the part is made ready.
std::optional<LocalSurface> find_local_surface(const geometry::Mesh& part, const Pose& X_WT);

/// Of the tip over the nominal part [m], along the tool axis; nothing where that does not meet the part
/// within 20 mm. What reaches up to kSurfaceRadius above the tip is seen.
std::optional<double> height_over(const geometry::Mesh& part, const Pose& X_WT);

}  // namespace understudy::control

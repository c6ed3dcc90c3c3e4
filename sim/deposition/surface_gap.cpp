#include "sim/deposition/surface_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::sim {
namespace {

constexpr double kLift = 5e-3;   // [m], the ray starts above the tip, which may be inside the part
constexpr double kPast = 10e-9;  // [m], the next ray starts past the last hit, by more than its rounding
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Whether a ray along `direction` enters the solid through the triangle.
bool enters(const geometry::Mesh& mesh, int triangle, const Vec3& direction) {
  const auto& t = mesh.triangles()[static_cast<std::size_t>(triangle)];
  const auto vertex = [&](std::size_t k) -> const Vec3& {
    return mesh.vertices()[static_cast<std::size_t>(t[k])];
  };
  return (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).dot(direction) < 0;
}

// Farther inside than the lift: out along the axis.
SurfaceGap gap_from_inside(const geometry::Mesh& part, const Vec3& tip, const Vec3& axis) {
  const auto exit = part.ray_hit(tip, axis, 1.0);
  if (!exit) return {-kInfinity};
  return {-exit->distance, exit->normal};
}

}  // namespace

SurfaceGap table_gap(const geometry::TableSurface& table, const Vec3& tip_W, const Vec3& axis_W) {
  const auto gap = table.ray_hit(tip_W, -axis_W);
  if (!gap || *gap > kGapReach) return {kInfinity};
  return {*gap, table.normal((tip_W - *gap * axis_W).head<2>())};
}

SurfaceGap part_gap(const geometry::Mesh& part, const Vec3& tip_W, const Vec3& axis_W) {
  const Vec3 origin = tip_W + kLift * axis_W;
  SurfaceGap entered{kInfinity};  // where the ray went into the solid that it is in
  double from = 0;
  while (from < kLift + kGapReach) {
    const auto hit = part.ray_hit(origin - from * axis_W, -axis_W, kLift + kGapReach - from);
    if (!hit) break;
    const double depth = from + hit->distance;
    if (enters(part, hit->triangle, -axis_W)) {
      if (depth >= kLift) return {depth - kLift, hit->normal};
      entered = {depth - kLift, hit->normal};
    } else {
      if (depth >= kLift) return std::isfinite(entered.gap) ? entered : gap_from_inside(part, tip_W, axis_W);
      entered = {kInfinity};
    }
    from = depth + kPast;
  }
  return entered;
}

}  // namespace understudy::sim

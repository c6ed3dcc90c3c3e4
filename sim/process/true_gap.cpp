#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/process/deposition.h"

namespace understudy::sim {
namespace {

constexpr double kLift = 5e-3;    // [m], the ray starts above the tip, which may be inside the part
constexpr double kPast = 10e-9;   // [m], the next ray starts past the last hit, by more than its rounding
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
double gap_from_inside(const geometry::Mesh& part, const Vec3& tip, const Vec3& axis) {
  const auto exit = part.ray_hit(tip, axis, 1.0);
  return exit ? -exit->distance : -kInfinity;
}

double part_gap(const geometry::Mesh& part, const Vec3& tip, const Vec3& axis) {
  const Vec3 origin = tip + kLift * axis;
  double entered = kInfinity;  // depth below the origin where the ray went into the solid that it is in
  double from = 0;
  while (from < kLift + kGapReach) {
    const auto hit = part.ray_hit(origin - from * axis, -axis, kLift + kGapReach - from);
    if (!hit) break;
    const double depth = from + hit->distance;
    if (enters(part, hit->triangle, -axis)) {
      if (depth >= kLift) return depth - kLift;
      entered = depth;
    } else {
      if (depth >= kLift) return std::isfinite(entered) ? entered - kLift : gap_from_inside(part, tip, axis);
      entered = kInfinity;
    }
    from = depth + kPast;
  }
  return entered - kLift;
}

double table_gap(const Vec3& tip, const Vec3& axis) {
  if (axis.z() <= 0) return kInfinity;
  const double gap = tip.z() / axis.z();
  return gap <= kGapReach ? gap : kInfinity;
}

}  // namespace

double true_gap(const geometry::Mesh* part, const Pose& X_WT) {
  const Vec3 tip = X_WT.translation(), axis = tool_axis(X_WT);
  const double table = table_gap(tip, axis);
  return part ? std::min(table, part_gap(*part, tip, axis)) : table;
}

}  // namespace understudy::sim

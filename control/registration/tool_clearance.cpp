#include "control/registration/tool_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <unordered_set>

namespace understudy::control {
namespace {

/// Of a solid of revolution about z, from the profile's distances outside radius and ends.
double revolved(double beyond_radius, double beyond_end) {
  const double outside = std::hypot(std::max(0.0, beyond_radius), std::max(0.0, beyond_end));
  return outside + std::min(0.0, std::max(beyond_radius, beyond_end));
}

double distance_in_shape(const geometry::Sphere& s, const Vec3& p) { return p.norm() - s.radius; }

double distance_in_shape(const geometry::Capsule& s, const Vec3& p) {
  const double z = std::clamp(p.z(), -s.length / 2, s.length / 2);
  return (p - Vec3(0, 0, z)).norm() - s.radius;
}

double distance_in_shape(const geometry::Cylinder& s, const Vec3& p) {
  return revolved(p.head<2>().norm() - s.radius, std::abs(p.z()) - s.length / 2);
}

/// Beside the cone exact, beyond its rims not farther than it is.
double distance_in_shape(const geometry::Frustum& s, const Vec3& p) {
  const double slope = (s.radius_top - s.radius_bottom) / s.height;
  const double beside = p.head<2>().norm() - (s.radius_bottom + slope * std::clamp(p.z(), 0.0, s.height));
  return revolved(beside / std::hypot(1, slope), std::max(-p.z(), p.z() - s.height));
}

double distance_in_shape(const geometry::Box& s, const Vec3& p) {
  const Vec3 beyond = p.cwiseAbs() - s.size / 2;
  return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
}

double distance_in_shape(const geometry::MeshShape& s, const Vec3& p) { return s.mesh->signed_distance(p); }

/// Radius and ends along z of what goes round about z.
struct Extent {
  double radius, low, high;
};
Extent extent_of(const geometry::Shape& shape) {
  return std::visit(
      machine::Overloaded{[](const geometry::Sphere& s) {
                            return Extent{s.radius, -s.radius, s.radius};
                          },
                          [](const geometry::Capsule& s) {
                            return Extent{s.radius, -s.length / 2 - s.radius, s.length / 2 + s.radius};
                          },
                          [](const geometry::Cylinder& s) {
                            return Extent{s.radius, -s.length / 2, s.length / 2};
                          },
                          [](const geometry::Frustum& s) {
                            return Extent{std::max(s.radius_bottom, s.radius_top), 0, s.height};
                          },
                          [](const geometry::Box& s) {
                            return Extent{s.size.head<2>().norm() / 2, -s.size.z() / 2, s.size.z() / 2};
                          },
                          [](const geometry::MeshShape& s) {
                            const double r = std::max(s.mesh->lower().norm(), s.mesh->upper().norm());
                            return Extent{r, -r, r};
                          }},
      shape.form);
}

/// Lowest z in W of a body.
double lowest(const geometry::Shape& body, const Pose& X_WT) {
  const Extent extent = extent_of(body);
  const Pose X_WS = X_WT * body.X_FS;
  const Vec3 axis = X_WS.linear().col(2);
  const double across = extent.radius * std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  return X_WS.translation().z() + std::min(extent.low * axis.z(), extent.high * axis.z()) - across;
}

}  // namespace

double distance_to(const geometry::Shape& body, const Vec3& p) {
  const Vec3 p_S = body.X_FS.inverse() * p;
  return std::visit([&](const auto& form) { return distance_in_shape(form, p_S); }, body.form);
}

std::vector<Vec3> cover(const geometry::Mesh& mesh, double spacing) {
  std::vector<Vec3> points;
  std::unordered_set<std::uint64_t> taken;
  const auto add = [&](const Vec3& p) {
    std::uint64_t cell = 0;
    for (int i = 0; i < 3; ++i) {
      constexpr std::uint64_t kPerAxis = std::uint64_t{1} << 21;
      // Rounding can put a point just below the least one.
      const auto step = static_cast<std::int64_t>(std::floor((p[i] - mesh.lower()[i]) / spacing));
      cell = cell * kPerAxis + static_cast<std::uint64_t>(step) % kPerAxis;
    }
    if (taken.insert(cell).second) points.push_back(p);
  };
  for (const auto& triangle : mesh.triangles()) {
    const auto corner = [&](std::size_t k) { return mesh.vertices()[static_cast<std::size_t>(triangle[k])]; };
    const Vec3 a = corner(0), u = corner(1) - a, v = corner(2) - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) add(a + (i * u + j * v) / parts);
  }
  return points;
}

double tool_clearance(const machine::MachineDescription& machine, const std::vector<Vec3>& points_W,
                      const Pose& X_WT, double beyond) {
  double least = std::numeric_limits<double>::infinity();
  for (const geometry::Shape& body : machine.tool.bodies) least = std::min(least, lowest(body, X_WT));
  const Pose X_TW = X_WT.inverse();
  for (const Vec3& p_W : points_W) {
    const Vec3 p_T = X_TW * p_W;
    if (p_T.norm() <= beyond) continue;
    for (const geometry::Shape& body : machine.tool.bodies) least = std::min(least, distance_to(body, p_T));
  }
  return least;
}

}  // namespace understudy::control

#include "toolpath/finishing/tool_rings.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::toolpath {
namespace {

/// Grows by the points of a body.
struct RingOf {
  const Pose& X_TF;
  ToolRing ring{"", 0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(const Vec3& p_F, double around = 0) {
    const Vec3 p = X_TF * p_F;
    ring.radius = std::max(ring.radius, p.head<2>().norm() + around);
    ring.from = std::min(ring.from, p.z() - around);
    ring.to = std::max(ring.to, p.z() + around);
  }
  /// A disc across z of F: exact where that is the tool's own axis.
  void add_disc(double radius, double z) {
    if (X_TF.linear().col(2).head<2>().norm() < 1e-9) {
      add(Vec3(0, 0, z));
      ring.radius = std::max(ring.radius, X_TF.translation().head<2>().norm() + radius);
    } else {
      for (int i = 0; i < 4; ++i) add(Vec3(i & 1 ? radius : -radius, i & 2 ? radius : -radius, z));
    }
  }
  void operator()(const geometry::Sphere& s) { add(Vec3::Zero(), s.radius); }
  void operator()(const geometry::Capsule& s) {
    for (const double z : {-s.length / 2, s.length / 2}) add(Vec3(0, 0, z), s.radius);
  }
  void operator()(const geometry::Cylinder& s) {
    for (const double z : {-s.length / 2, s.length / 2}) add_disc(s.radius, z);
  }
  void operator()(const geometry::Frustum& s) {
    add_disc(s.radius_bottom, 0);
    add_disc(s.radius_top, s.height);
  }
  void operator()(const geometry::Box& s) {
    for (int i = 0; i < 8; ++i)
      add(0.5 * Vec3(i & 1 ? s.size.x() : -s.size.x(), i & 2 ? s.size.y() : -s.size.y(),
                     i & 4 ? s.size.z() : -s.size.z()));
  }
  void operator()(const geometry::MeshShape& s) {
    for (const Vec3& v : s.mesh->vertices()) add(v);
  }
};

}  // namespace

std::vector<ToolRing> tool_rings(const std::vector<geometry::Shape>& bodies, double mill_radius) {
  constexpr double kRounding = 1 * kMicrometre;
  std::vector<ToolRing> rings;
  for (const geometry::Shape& body : bodies) {
    RingOf of{body.X_FS};
    std::visit(of, body.form);
    if (of.ring.from < kRounding && of.ring.radius < mill_radius + kRounding) continue;
    of.ring.name = body.name;
    rings.push_back(of.ring);
  }
  return rings;
}

}  // namespace understudy::toolpath

#include "toolpath/lattice/tool_envelope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "geometry/mesh.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

using geometry::Shape;

constexpr double kNearlyTouching = 20 * kMicrometre;
constexpr double kOnAxis = 1e-9;  // [m] and [1]

struct Extent {
  double z0 = std::numeric_limits<double>::infinity(), z1 = -z0, radius = 0;
  void add(const Vec3& p, double around = 0) {
    z0 = std::min(z0, p.z() - around);
    z1 = std::max(z1, p.z() + around);
    radius = std::max(radius, p.head<2>().norm() + around);
  }
};

void add_box(Extent& extent, const Pose& X_TF, const Vec3& lower, const Vec3& upper) {
  for (int i = 0; i < 8; ++i)
    extent.add(X_TF * Vec3(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                           i & 4 ? upper.z() : lower.z()));
}

struct ExtentOf {
  const Pose& X_TF;
  Extent extent{};
  void operator()(const geometry::Sphere& s) { extent.add(X_TF.translation(), s.radius); }
  void operator()(const geometry::Capsule& s) {
    extent.add(X_TF * Vec3(0, 0, -0.5 * s.length), s.radius);
    extent.add(X_TF * Vec3(0, 0, 0.5 * s.length), s.radius);
  }
  void operator()(const geometry::Cylinder& s) { round(s.radius, -0.5 * s.length, 0.5 * s.length); }
  void operator()(const geometry::Frustum& s) { round(std::max(s.radius_bottom, s.radius_top), 0, s.height); }
  void operator()(const geometry::Box& s) { add_box(extent, X_TF, -0.5 * s.size, 0.5 * s.size); }
  void operator()(const geometry::MeshShape& s) {
    for (const Vec3& v : s.mesh->vertices()) extent.add(X_TF * v);
  }
  void round(double radius, double z0, double z1) {
    add_box(extent, X_TF, Vec3(-radius, -radius, z0), Vec3(radius, radius, z1));
  }
};

// Signed distance of a point (rho, z), rho >= 0, to the trapezium between the axis and a sloped side. Of a
// solid of revolution the nearest point lies in the half-plane of the point, so this is the distance in
// space.
double trapezium_distance(double rho, double z, double z0, double z1, double r0, double r1) {
  const Vec3 p(rho, z, 0), a(0, z0, 0), b(r0, z0, 0), c(r1, z1, 0), d(0, z1, 0);
  const double to_side =
      std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, d)});
  const bool inside = z >= z0 && z <= z1 && rho * (z1 - z0) <= r0 * (z1 - z) + r1 * (z - z0);
  return inside ? -to_side : to_side;
}

// Distances of a strut to a moving tool over the rectangle of both parameters: a point of the strut by
// another amount, or the tool by another amount, changes a distance by no more than that.
class StrutSweep {
 public:
  StrutSweep(const ToolEnvelope& tool, const StrutBody& strut, const ToolMotion& motion) : tool_(tool) {
    const Mat3 R_TW = shortest_arc_from_z(motion.axis).toRotationMatrix().transpose();
    start_ = R_TW * (strut.from - motion.from);
    along_strut_ = R_TW * (strut.to - strut.from);
    along_motion_ = R_TW * (motion.from - motion.to);
    radius_ = strut.radius;
  }

  struct Patch {
    double s, u, half_s, half_u;
  };
  double distance(const Patch& p) const {
    return tool_.distance(start_ + p.s * along_strut_ + p.u * along_motion_) - radius_;
  }
  double reach(const Patch& p) const {
    return p.half_s * along_strut_.norm() + p.half_u * along_motion_.norm();
  }
  std::array<Patch, 2> halves(const Patch& p) const {
    if (p.half_s * along_strut_.norm() > p.half_u * along_motion_.norm())
      return {Patch{p.s - 0.5 * p.half_s, p.u, 0.5 * p.half_s, p.half_u},
              Patch{p.s + 0.5 * p.half_s, p.u, 0.5 * p.half_s, p.half_u}};
    return {Patch{p.s, p.u - 0.5 * p.half_u, p.half_s, 0.5 * p.half_u},
            Patch{p.s, p.u + 0.5 * p.half_u, p.half_s, 0.5 * p.half_u}};
  }

  bool clears(const Patch& p, double margin) const {
    const double at_middle = distance(p), reach_of_patch = reach(p);
    if (at_middle - reach_of_patch >= margin) return true;
    if (at_middle < margin || reach_of_patch < kNearlyTouching) return false;
    const auto [first, second] = halves(p);
    return clears(first, margin) && clears(second, margin);
  }

  void lower_bound(const Patch& p, double tolerance, double& smallest) const {
    const double bound = distance(p) - reach(p);
    if (bound >= smallest) return;
    if (reach(p) <= tolerance) {
      smallest = bound;
      return;
    }
    for (const Patch& half : halves(p)) lower_bound(half, tolerance, smallest);
  }

 private:
  const ToolEnvelope& tool_;
  Vec3 start_, along_strut_, along_motion_;
  double radius_;
};

constexpr StrutSweep::Patch kWhole{0.5, 0.5, 0.5, 0.5};

}  // namespace

ToolEnvelope::ToolEnvelope(const std::vector<Shape>& bodies) {
  for (const Shape& body : bodies) {
    const Vec3 p = body.X_FS.translation(), axis = body.X_FS.linear().col(2);
    const bool coaxial = p.head<2>().norm() < kOnAxis && axis.z() > 1 - kOnAxis;
    if (const auto* f = std::get_if<geometry::Frustum>(&body.form); f && coaxial) {
      sections_.push_back({p.z(), p.z() + f->height, f->radius_bottom, f->radius_top});
    } else if (const auto* c = std::get_if<geometry::Cylinder>(&body.form); c && coaxial) {
      sections_.push_back({p.z() - 0.5 * c->length, p.z() + 0.5 * c->length, c->radius, c->radius});
    } else {
      ExtentOf of{body.X_FS};
      std::visit(of, body.form);
      sections_.push_back({of.extent.z0, of.extent.z1, of.extent.radius, of.extent.radius});
    }
  }
}

double ToolEnvelope::distance(const Vec3& p) const {
  const double rho = p.head<2>().norm();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Section& s : sections_)
    nearest = std::min(nearest, trapezium_distance(rho, p.z(), s.z0, s.z1, s.r0, s.r1));
  return nearest;
}

double ToolEnvelope::distance(const StrutBody& strut, const ToolMotion& motion, double tolerance) const {
  const StrutSweep sweep(*this, strut, motion);
  double smallest = sweep.distance(kWhole);
  sweep.lower_bound(kWhole, tolerance, smallest);
  return smallest;
}

bool ToolEnvelope::clears(const StrutBody& strut, const ToolMotion& motion, double margin) const {
  return StrutSweep(*this, strut, motion).clears(kWhole, margin);
}

double ToolEnvelope::lowest(const Vec3& axis) const {
  const double level = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  double lowest = 0;
  for (const Section& s : sections_)
    lowest = std::min({lowest, axis.z() * s.z0 - level * s.r0, axis.z() * s.z1 - level * s.r1});
  return lowest;
}

double ToolEnvelope::radius() const {
  double radius = 0;
  for (const Section& s : sections_) radius = std::max({radius, s.r0, s.r1});
  return radius;
}

}  // namespace understudy::toolpath

#include "toolpath/lattice/tool_envelope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "geometry/mesh.h"
#include "geometry/printed_clearance.h"

namespace understudy::toolpath {
namespace {

using geometry::Shape;

constexpr double kNearlyTouching = 2 * kMicrometre;
constexpr double kOnAxis = 1e-9;  // [m] and [1]
constexpr double kFar = 1e4;      // [m], beyond every lattice
constexpr double kTurnStep = 2 * kDegree;

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
  const auto length = [](double a, double b) { return std::sqrt(a * a + b * b); };
  if (r0 == r1) {
    const double out = rho - r0, beyond = std::max(z0 - z, z - z1);
    return out > 0 && beyond > 0 ? length(out, beyond) : std::max(out, beyond);
  }
  const double dr = r1 - r0, dz = z1 - z0;
  const double t = std::clamp(((rho - r0) * dr + (z - z0) * dz) / (dr * dr + dz * dz), 0.0, 1.0);
  const double to_side = length(rho - r0 - t * dr, z - z0 - t * dz);
  const double to_ends =
      std::min(length(std::max(0.0, rho - r0), z - z0), length(std::max(0.0, rho - r1), z - z1));
  const bool inside = z >= z0 && z <= z1 && (rho - r0) * dz <= dr * (z - z0);
  return inside ? -std::min(to_side, to_ends) : std::min(to_side, to_ends);
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

ToolEnvelope::ToolEnvelope(const std::vector<Shape>& bodies, double press) {
  for (const Shape& body : bodies) {
    const double into = geometry::is_nozzle(body.name) ? press : 0;
    const Vec3 p = body.X_FS.translation(), axis = body.X_FS.linear().col(2);
    const bool coaxial = p.head<2>().norm() < kOnAxis && axis.z() > 1 - kOnAxis;
    if (const auto* f = std::get_if<geometry::Frustum>(&body.form); f && coaxial) {
      sections_.push_back({p.z(), p.z() + f->height, f->radius_bottom, f->radius_top, into});
    } else if (const auto* c = std::get_if<geometry::Cylinder>(&body.form); c && coaxial) {
      sections_.push_back({p.z() - 0.5 * c->length, p.z() + 0.5 * c->length, c->radius, c->radius, into});
    } else {
      ExtentOf of{body.X_FS};
      std::visit(of, body.form);
      sections_.push_back({of.extent.z0, of.extent.z1, of.extent.radius, of.extent.radius, into});
    }
  }
}

bool ToolEnvelope::holds(const Section& outer, const Section& inner) {
  return outer.z0 <= inner.z0 && outer.z1 >= inner.z1 && outer.press <= inner.press &&
         std::min(outer.r0, outer.r1) >= std::max(inner.r0, inner.r1);
}

ToolEnvelope ToolEnvelope::lifted() const {
  std::vector<Section> swept;
  for (const Section& s : sections_) {
    const double widest = std::max(s.r0, s.r1);
    if (s.r0 < s.r1) swept.push_back(s);
    swept.push_back({s.r0 < s.r1 ? s.z1 : s.z0, kFar, widest, widest, s.press});
  }
  // What lies within another one adds nothing.
  ToolEnvelope lifted(*this);
  std::vector<Section>& outer = lifted.sections_;
  outer.clear();
  for (const Section& s : swept)
    if (std::none_of(outer.begin(), outer.end(), [&](const Section& o) { return holds(o, s); })) {
      std::erase_if(outer, [&](const Section& o) { return holds(s, o); });
      outer.push_back(s);
    }
  return lifted;
}

double ToolEnvelope::distance(const Vec3& p) const {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  double nearest = std::numeric_limits<double>::infinity();
  for (const Section& s : sections_)
    nearest = std::min(nearest, trapezium_distance(rho, p.z(), s.z0, s.z1, s.r0, s.r1) + s.press);
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

bool ToolEnvelope::clears_turn(const StrutBody& strut, const Vec3& tip, const Vec3& from_axis,
                               const Vec3& to_axis, double margin) const {
  const double turn = std::acos(std::clamp(from_axis.dot(to_axis), -1.0, 1.0));
  const int steps = static_cast<int>(std::ceil(turn / kTurnStep));
  const Quat whole = Quat::FromTwoVectors(from_axis, to_axis);
  // A point at the tool's far end moves by half a step to either side of a pose that is looked at.
  const double between = steps == 0 ? 0 : 0.5 * turn / steps * reach();
  for (int k = 0; k <= steps; ++k) {
    const Vec3 axis = Quat::Identity().slerp(steps == 0 ? 0 : double(k) / steps, whole) * from_axis;
    if (!clears(strut, {tip, tip, axis}, margin + between)) return false;
  }
  return true;
}

double ToolEnvelope::lowest(const Vec3& axis) const {
  const double level = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  double lowest = 0;
  for (const Section& s : sections_)
    lowest = std::min({lowest, axis.z() * s.z0 - level * s.r0, axis.z() * s.z1 - level * s.r1});
  return lowest;
}

double ToolEnvelope::radius(double below) const {
  double radius = 0;
  for (const Section& s : sections_) {
    if (s.z0 > below) continue;
    const double share = s.z1 > below ? (below - s.z0) / (s.z1 - s.z0) : 1;
    radius = std::max({radius, s.r0, s.r0 + share * (s.r1 - s.r0)});
  }
  return radius;
}

double ToolEnvelope::reach() const {
  double reach = 0;
  for (const Section& s : sections_)
    reach = std::max({reach, std::hypot(s.z0, s.r0), std::hypot(s.z1, s.r1)});
  return reach;
}

}  // namespace understudy::toolpath

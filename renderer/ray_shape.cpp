#include "renderer/ray_shape.h"

#include <array>
#include <cmath>
#include <limits>

#include "geometry/mesh.h"

namespace understudy::renderer {
namespace {

/// A ray in the shape's own frame that keeps its nearest hit.
struct Ray {
  Vec3 o, d;
  double nearest;

  Vec3 at(double t) const { return o + t * d; }
  void hit(double t) {
    if (t > 0 && t < nearest) nearest = t;
  }
};

/// Both roots of a t^2 + 2 b t + c; none when they are complex or there is nothing to solve.
template <typename Visit>
void roots(double a, double b, double c, Visit visit) {
  if (std::abs(a) < 1e-15) {
    if (b != 0) visit(-c / (2 * b));
    return;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;
  // The larger root first: the other follows from their product without cancellation.
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  visit(q / a);
  if (q != 0) visit(c / q);
}

void cast_sphere(Ray& ray, const Vec3& centre, double radius, double z_min, double z_max) {
  const Vec3 o = ray.o - centre;
  roots(1, o.dot(ray.d), o.squaredNorm() - radius * radius, [&](double t) {
    const double z = ray.at(t).z();
    if (z >= z_min && z <= z_max) ray.hit(t);
  });
}

void cast_disc(Ray& ray, double z, double radius) {
  if (ray.d.z() == 0) return;
  const double t = (z - ray.o.z()) / ray.d.z();
  if (ray.at(t).head<2>().squaredNorm() <= radius * radius) ray.hit(t);
}

/// The side of a cone or cylinder: radius r0 at z0, growing by `slope` per metre of z.
void cast_side(Ray& ray, double r0, double slope, double z0, double z1) {
  const double r = r0 + slope * (ray.o.z() - z0);
  const double dr = slope * ray.d.z();
  const Vec2 o = ray.o.head<2>(), d = ray.d.head<2>();
  roots(d.squaredNorm() - dr * dr, o.dot(d) - r * dr, o.squaredNorm() - r * r, [&](double t) {
    const double z = ray.at(t).z();
    if (z >= z0 && z <= z1) ray.hit(t);
  });
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void cast(Ray& ray, const geometry::Sphere& s) {
  cast_sphere(ray, Vec3::Zero(), s.radius, -kInfinity, kInfinity);
}

void cast(Ray& ray, const geometry::Capsule& c) {
  const double h = c.length / 2;
  cast_side(ray, c.radius, 0, -h, h);
  cast_sphere(ray, Vec3(0, 0, h), c.radius, h, kInfinity);
  cast_sphere(ray, Vec3(0, 0, -h), c.radius, -kInfinity, -h);
}

void cast(Ray& ray, const geometry::Cylinder& c) {
  const double h = c.length / 2;
  cast_side(ray, c.radius, 0, -h, h);
  cast_disc(ray, -h, c.radius);
  cast_disc(ray, h, c.radius);
}

void cast(Ray& ray, const geometry::Frustum& f) {
  cast_side(ray, f.radius_bottom, (f.radius_top - f.radius_bottom) / f.height, 0, f.height);
  cast_disc(ray, 0, f.radius_bottom);
  cast_disc(ray, f.height, f.radius_top);
}

void cast(Ray& ray, const geometry::Box& box) {
  const Vec3 half = box.size / 2;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.d[axis] == 0) continue;
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * half[axis] - ray.o[axis]) / ray.d[axis];
      const Vec3 p = ray.at(t);
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (std::abs(p[u]) <= half[u] && std::abs(p[v]) <= half[v]) ray.hit(t);
    }
  }
}

void cast(Ray& ray, const geometry::MeshShape& m) {
  if (const auto hit = m.mesh->ray_hit(ray.o, ray.d, ray.nearest)) ray.hit(hit->distance);
}

}  // namespace

std::optional<double> ray_hit(const geometry::Shape& shape, const Vec3& origin, const Vec3& direction,
                              double reach) {
  const Pose X_SF = shape.X_FS.inverse();
  Ray ray{X_SF * origin, X_SF.linear() * direction, reach};
  std::visit([&](const auto& form) { cast(ray, form); }, shape.form);
  if (ray.nearest < reach) return ray.nearest;
  return std::nullopt;
}

}  // namespace understudy::renderer

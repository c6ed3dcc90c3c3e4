// The laser dot by exact geometry: a straight beam, a plane or cylinder, a pinhole. The code under test has
// its own way to the same pixel; this one shares nothing with it but the machine description.
#pragma once

#include <cmath>
#include <optional>

#include "machine/description.h"

namespace understudy::control {

/// A part under the tool, in W: everything below a plane, or inside a cylinder of infinite length.
struct DotWorld {
  Vec3 point{0, 0, 0};      ///< on the plane, or on the cylinder's axis
  Vec3 direction{0, 0, 1};  ///< the plane's normal, or the cylinder's axis; unit
  double radius = 0;        ///< [m]; 0: a plane
};

inline DotWorld plane_through(const Vec3& point, const Vec3& normal) {
  return {point, normal.normalized(), 0};
}
inline DotWorld cylinder_around(const Vec3& point, const Vec3& axis, double radius) {
  return {point, axis.normalized(), radius};
}

/// Distance along the ray to where it enters the part.
inline std::optional<double> enter(const DotWorld& world, const Vec3& origin, const Vec3& ray) {
  if (world.radius == 0) {
    const double fall = ray.dot(world.direction);
    if (!(fall < 0)) return std::nullopt;
    return (world.point - origin).dot(world.direction) / fall;
  }
  const auto across = [&](const Vec3& v) -> Vec3 { return v - v.dot(world.direction) * world.direction; };
  const Vec3 o = across(origin - world.point), r = across(ray);
  const double a = r.squaredNorm(), b = o.dot(r), c = o.squaredNorm() - world.radius * world.radius;
  const double root = b * b - a * c;
  if (!(root > 0)) return std::nullopt;
  return (-b - std::sqrt(root)) / a;
}

/// The gap along the tool axis, negative inside.
inline double true_gap(const DotWorld& world, const Pose& X_WT) {
  return enter(world, X_WT.translation(), -tool_axis(X_WT)).value_or(std::nan(""));
}

/// Where the dot falls on the sensor, unlimited by its size.
inline std::optional<Vec2> exact_dot(const machine::MachineDescription& m, const DotWorld& world,
                                     const Pose& X_WT) {
  const Pose X_WL = X_WT * m.laser.X_TL;
  const Vec3 ray = X_WL.linear().col(2);
  const auto t = enter(world, X_WL.translation(), ray);
  if (!t) return std::nullopt;
  const Vec3 p_C = (X_WT * m.microscope.X_TC).inverse() * Vec3(X_WL.translation() + *t * ray);
  const Camera& camera = m.microscope.camera;
  return Vec2(camera.centre_px + camera.focal_px / p_C.z() * p_C.head<2>());
}

/// Second moments [px^2] of the dot where it falls: rays a standard deviation beside the beam's axis, and the
/// blur of the optics. The beam's 1/e^2 diameter is four standard deviations.
inline std::optional<Eigen::Matrix2d> exact_spread(machine::MachineDescription m, const DotWorld& world,
                                                   const Pose& X_WT) {
  const auto centre = exact_dot(m, world, X_WT);
  Eigen::Matrix2d spread = m.microscope.blur_px * m.microscope.blur_px * Eigen::Matrix2d::Identity();
  const Pose X_TL = m.laser.X_TL;
  for (int i = 0; i < 2; ++i) {
    m.laser.X_TL.translation() = X_TL.translation() + m.laser.waist_diameter / 4 * X_TL.linear().col(i);
    const auto beside = exact_dot(m, world, X_WT);
    if (!centre || !beside) return std::nullopt;
    spread += (*beside - *centre) * (*beside - *centre).transpose();
  }
  return spread;
}

}  // namespace understudy::control

#include "calibration/gap_sensor/flat_dot.h"

namespace understudy::calibration {

std::optional<Vec3> dot_on_flat(const machine::OpticsMounting& mounting, const Flat& flat) {
  const Vec3 origin = mounting.X_TL.translation(), beam = mounting.X_TL.linear().col(2);
  const Vec3 normal(-flat.slope.x(), -flat.slope.y(), 1);  // normal . p = -gap on the flat
  const double fall = -normal.dot(beam);
  if (!(fall > 0)) return std::nullopt;
  return Vec3(origin + (normal.dot(origin) + flat.gap) / fall * beam);
}

std::optional<Vec2> dot_pixel(const machine::OpticsMounting& mounting, Camera camera, const Flat& flat) {
  const auto p_T = dot_on_flat(mounting, flat);
  if (!p_T) return std::nullopt;
  camera.focal_px = mounting.focal_px;
  return camera.project(mounting.X_TC.inverse() * *p_T);
}

std::optional<Eigen::Matrix2d> dot_spread(const machine::OpticsMounting& mounting, double waist_diameter,
                                          const Camera& camera, const Flat& flat) {
  const auto seen_beside = [&](const Vec3& shift_L) {
    machine::OpticsMounting ray = mounting;
    ray.X_TL.translation() += ray.X_TL.linear() * shift_L;
    return dot_pixel(ray, camera, flat);
  };
  const double sigma = waist_diameter / 4;  // of a beam whose 1/e^2 diameter is the waist's
  Eigen::Matrix2d across;
  for (int i = 0; i < 2; ++i) {
    const auto behind = seen_beside(-sigma * Vec3::Unit(i)), ahead = seen_beside(sigma * Vec3::Unit(i));
    if (!behind || !ahead) return std::nullopt;
    across.col(i) = 0.5 * (*ahead - *behind);
  }
  return across * across.transpose();
}

}  // namespace understudy::calibration

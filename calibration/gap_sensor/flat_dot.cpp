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

}  // namespace understudy::calibration

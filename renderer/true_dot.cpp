#include <limits>

#include "renderer/laser_view.h"
#include "renderer/ray_shape.h"

namespace understudy::renderer {
namespace {

constexpr double kReach = 1.0;    // [m], farther than any machine
constexpr double kLift = 0.5e-6;  // [m], off the surface, so that a ray from it does not meet it again

/// Distance to the first thing on the ray, in W; `kReach` when there is none.
double first_hit(const LaserScene& scene, const Vec3& origin, const Vec3& direction, double reach) {
  double nearest = reach;
  for (const auto& mesh : {scene.part, scene.printed}) {
    if (!mesh) continue;
    if (const auto hit = mesh->ray_hit(origin, direction, nearest)) nearest = hit->distance;
  }
  if (scene.table)
    if (const auto t = scene.table_top.ray_hit(origin, direction); t && *t > 0 && *t < nearest) nearest = *t;
  const Pose X_TW = scene.X_WT.inverse();
  const Vec3 origin_T = X_TW * origin, direction_T = X_TW.linear() * direction;
  for (const auto& body : scene.tool_bodies) {
    if (const auto t = ray_hit(body, origin_T, direction_T, nearest)) nearest = *t;
  }
  return nearest;
}

}  // namespace

bool true_dot(const LaserScene& scene, Vec2& pixel) {
  const Pose X_WL = scene.X_WT * scene.X_TL;
  const Pose X_WC = scene.X_WT * scene.X_TC;
  const Vec3 beam = X_WL.linear().col(2);
  const double along = first_hit(scene, X_WL.translation(), beam, kReach);
  if (along >= kReach) return false;
  const Vec3 dot = X_WL.translation() + along * beam;

  const Vec3 to_camera = X_WC.translation() - dot;
  const double distance = to_camera.norm();
  const Vec3 view = to_camera / distance;
  // Back along the beam is outside whatever the beam met, so the ray to the camera starts there.
  const Vec3 start = dot - kLift * beam;
  if (first_hit(scene, start, view, distance) < distance) return false;

  const auto projected = scene.camera.project(X_WC.inverse() * dot);
  if (!projected) return false;
  pixel = *projected;
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < scene.camera.width - 0.5 &&
         pixel.y() < scene.camera.height - 0.5;
}

}  // namespace understudy::renderer

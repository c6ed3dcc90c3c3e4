#include <algorithm>
#include <cmath>

#include "renderer/calibration_view.h"

namespace understudy::renderer {

std::vector<std::optional<Vec2>> true_corners(const BoardScene& scene) {
  std::vector<std::optional<Vec2>> pixels;
  for (int r = 0; r < scene.rows; ++r) {
    for (int c = 0; c < scene.columns; ++c) {
      const double x = c - 0.5 * (scene.columns - 1), y = r - 0.5 * (scene.rows - 1);
      const Vec2 at(2 * x / (scene.columns - 1), 2 * y / (scene.rows - 1));
      const double up = scene.bow.dot(Vec3(at.x() * at.x(), at.x() * at.y(), at.y() * at.y()));
      const Vec3 p_G(scene.square * x, scene.square * y, up);
      pixels.push_back(scene.camera.project(scene.X_CG * p_G));
    }
  }
  return pixels;
}

std::optional<Vec2> true_sphere_centre(const Camera& camera, const Vec3& centre_C) {
  return camera.project(centre_C);
}

std::optional<Vec2> true_outline_centre(const Camera& camera, const Vec3& centre_C, double radius) {
  const double z = centre_C.z();
  if (!(z > radius)) return std::nullopt;
  // The cone of tangents cuts the picture's plane in an ellipse whose centre is at (X, Y) Z / (Z^2 - R^2).
  const double stretch = z / (z * z - radius * radius);
  return camera.project({centre_C.x() * stretch, centre_C.y() * stretch, 1});
}

Region region_of_targets(const TargetScene& scene, int margin_px) {
  Eigen::AlignedBox2d box;
  for (const Vec3& c : scene.centres_C) {
    const auto pixel = true_sphere_centre(scene.camera, c);
    if (!pixel) continue;
    const double reach = 1.1 * scene.camera.focal_px * scene.radius / c.z() + margin_px;
    box.extend(*pixel + Vec2(reach, reach));
    box.extend(*pixel - Vec2(reach, reach));
  }
  if (box.isEmpty()) return {};
  const double width = scene.camera.width, height = scene.camera.height;
  const int left = static_cast<int>(std::floor(std::clamp(box.min().x(), 0.0, width)));
  const int top = static_cast<int>(std::floor(std::clamp(box.min().y(), 0.0, height)));
  return {left, top, static_cast<int>(std::ceil(std::clamp(box.max().x(), 0.0, width))) - left,
          static_cast<int>(std::ceil(std::clamp(box.max().y(), 0.0, height))) - top};
}

}  // namespace understudy::renderer

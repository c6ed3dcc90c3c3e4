#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "report/picture/workspace_drawing.h"

namespace understudy::report {
namespace {

using Colour = std::array<float, 3>;
constexpr Colour kTable{0.82f, 0.82f, 0.84f}, kEdge{0.10f, 0.10f, 0.12f};
constexpr int kCellsInView = 96;

/// The renderer takes linear light, pictures hold sRGB.
Colour linear(const Rgb& colour) {
  Colour result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<float>(std::pow(colour[i] / 255.0, 2.2));
  return result;
}

Vec3 corner(const kinematics::WorkspaceGrid& grid, int k) {
  return {k & 1 ? grid.upper.x() : grid.lower.x(), k & 2 ? grid.upper.y() : grid.lower.y(),
          k & 4 ? grid.upper.z() : grid.lower.z()};
}

void add_box(const kinematics::WorkspaceGrid& grid, double radius, renderer::PictureScene& scene) {
  for (int k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis)
      if (!(k & 1 << axis) && grid.upper[axis] > grid.lower[axis])
        scene.polylines.push_back({{corner(grid, k), corner(grid, k | 1 << axis)}, kEdge, radius});
}

Vec2 pixel_of(const renderer::PictureScene& scene, const Vec3& p_W) {
  const Vec3 forward = (scene.target_W - scene.eye_W).normalized();
  const Vec3 right = forward.cross(scene.up_W).normalized(), up = right.cross(forward);
  const Vec3 ray = p_W - scene.eye_W;
  const double scale = scene.height / (2 * std::tan(scene.field_of_view / 2)) / ray.dot(forward);
  return {scene.width / 2.0 + scale * ray.dot(right), scene.height / 2.0 - scale * ray.dot(up)};
}

}  // namespace

WorkspaceView view_workspace(const studies::WorkspaceStudy& study, int width, int height) {
  const auto& grid = study.workspace.grid;
  const Vec3 middle = 0.5 * (grid.lower + grid.upper), size = grid.upper - grid.lower;
  const double radius = std::max(0.5 * size.norm(), kMillimetre);
  renderer::PictureScene scene;
  scene.width = width;
  scene.height = height;
  scene.field_of_view = from_deg(28);
  scene.target_W = middle;
  // So far that the sphere about the box fills the picture.
  scene.eye_W =
      middle + 1.02 * radius / std::sin(scene.field_of_view / 2) * Vec3(0.46, -0.77, 0.44).normalized();
  for (auto& part : workspace_surface(study.workspace, kCellsInView)) {
    const Rgb colour = part.family < 0 ? margin_colour(0.35) : limit_colour(part.family);
    scene.shapes.push_back({{"workspace", geometry::MeshShape{part.mesh}}, linear(colour)});
  }
  scene.shapes.push_back({study.machine.table, kTable});
  add_box(grid, 0.004 * radius, scene);

  const double gap = 0.10 * radius;
  WorkspaceView view;
  view.axis_label_px = {pixel_of(scene, Vec3(middle.x(), grid.lower.y() - gap, grid.lower.z())),
                        pixel_of(scene, Vec3(grid.upper.x() + gap, middle.y(), grid.lower.z())),
                        pixel_of(scene, Vec3(grid.lower.x() - gap, grid.lower.y(), middle.z()))};
  view.picture = renderer::render_picture(scene);
  return view;
}

}  // namespace understudy::report

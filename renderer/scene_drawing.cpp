#include "renderer/scene_drawing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace understudy::renderer {
namespace {

const std::vector<int> kLayout = {3, 3, 3};

}  // namespace

Mat3 eye_axes(const PictureScene& scene) {
  const Vec3 forward = scene.target_W - scene.eye_W;
  const Vec3 right = forward.cross(scene.up_W);
  if (!(forward.norm() > 0) || !(right.norm() > 1e-9 * forward.norm())) {
    throw InputError("picture: the eye must look at a target apart from it, across the up direction");
  }
  Mat3 axes;
  axes << right.normalized().transpose(), right.cross(forward).normalized().transpose(),
      -forward.normalized().transpose();
  return axes;
}

Eigen::Matrix4f eye_clip(const PictureScene& scene, const PictureGeometry& g) {
  const Mat3 axes = eye_axes(scene);
  const Vec3 eye = scene.eye_W - g.centre;
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = axes;
  view.topRightCorner<3, 1>() = -(axes * eye);
  const double far = eye.norm() + 6 * g.radius;
  const double near = std::max(far * 1e-3, eye.norm() - 1.1 * g.radius);
  const double cot = 1 / std::tan(scene.field_of_view / 2);
  Eigen::Matrix4d lens = Eigen::Matrix4d::Zero();
  lens(0, 0) = cot * scene.height / scene.width;
  lens(1, 1) = cot;
  lens(2, 2) = -(far + near) / (far - near);
  lens(2, 3) = -2 * far * near / (far - near);
  lens(3, 2) = -1;
  return (lens * view).cast<float>();
}

GlSurface::GlSurface(const GlFunctions& gl, const PictureTriangles& from)
    : vertices(gl, kLayout), triangles(gl) {
  vertices.fill(from.vertices);
  triangles.fill(from.corners);
}

void draw_all_pixels(const GlFunctions& gl) {
  GlVertices all(gl, {3});
  all.fill({-1, -1, 0, 3, -1, 0, -1, 3, 0});
  gl.Disable(GL_DEPTH_TEST);
  all.draw(GL_TRIANGLES);
  gl.Enable(GL_DEPTH_TEST);
}

}  // namespace understudy::renderer

#include "renderer/scene_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "renderer/gl_context.h"
#include "renderer/hidden_triangles.h"
#include "renderer/scene_geometry.h"
#include "renderer/shaders.h"

namespace understudy::renderer {
namespace {

constexpr int kSky = 48, kTilesX = 8, kTilesY = 6,
              kTile = 256;  // shadow maps of the sky's lights, in one atlas
constexpr int kLampMap = 2048;
const std::vector<int> kLayout = {3, 3, 3};

using Mat4f = Eigen::Matrix4f;

/// Orthographic clip coordinates of a light that shines on the whole scene from `direction`.
Mat4f light_clip(const Vec3& direction, double radius) {
  Mat3 axes;  // rows: right, up, towards the light
  const Vec3 right = direction.unitOrthogonal();
  axes << right.transpose(), direction.cross(right).transpose(), direction.transpose();
  Eigen::Matrix4d clip = Eigen::Matrix4d::Identity();
  clip.topLeftCorner<3, 3>() = axes / (1.02 * radius);
  clip.row(2) *= -1;  // near the light is near
  return clip.cast<float>();
}

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

Mat4f eye_clip(const PictureScene& scene, const PictureGeometry& g) {
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

/// The lamp stands over the viewer's left shoulder.
Vec3 lamp_direction(const PictureScene& scene) {
  const Mat3 axes = eye_axes(scene);
  const Vec3 direction = axes.transpose() * Vec3(-0.45, 0.35, 0.55) + 0.75 * Vec3::UnitZ();
  return direction.normalized();
}

void check(const PictureScene& s) {
  constexpr int kLargest = 8192;
  if (s.width < 1 || s.height < 1 || s.width > kLargest || s.height > kLargest) {
    throw InputError("picture: " + std::to_string(s.width) + " x " + std::to_string(s.height) +
                     " pixels, must be in 1.." + std::to_string(kLargest));
  }
  if (!(s.field_of_view > 0 && s.field_of_view < 3)) {
    throw InputError("picture: field of view is " + std::to_string(s.field_of_view) +
                     " rad, must be in 0..3");
  }
}

/// A depth texture that is compared with when it is looked up.
void compare_when_sampled(const GlFunctions& gl, GLenum unit, const GlTarget& map) {
  gl.ActiveTexture(unit);
  gl.BindTexture(GL_TEXTURE_2D, map.depth());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

struct Lights {
  std::vector<Eigen::Vector3f> directions;
  std::vector<Mat4f> clips;
  Vec3 lamp{0, 0, 1};
  Mat4f lamp_clip;
};

Lights make_lights(const PictureScene& scene, double radius) {
  Lights lights;
  for (const Vec3& direction : sky_directions(kSky)) {
    lights.directions.push_back(direction.cast<float>());
    lights.clips.push_back(light_clip(direction, radius));
  }
  lights.lamp = lamp_direction(scene);
  lights.lamp_clip = light_clip(lights.lamp, radius);
  return lights;
}

/// Vertices on the graphics side, and the triangles of them that are drawn.
struct GlSurface {
  explicit GlSurface(const GlFunctions& gl, const PictureTriangles& from)
      : vertices(gl, kLayout), triangles(gl) {
    vertices.fill(from.vertices);
    triangles.fill(from.corners);
  }
  void draw() const { vertices.draw(triangles); }

  GlVertices vertices;
  GlTriangles triangles;
};

void draw_shadows(const GlFunctions& gl, const Lights& lights, const GlSurface& solids,
                  const GlTriangles& casters, const GlTarget& atlas, const GlTarget& lamp) {
  const GlProgram program(gl, "depth", shader_source("depth.vert"), shader_source("depth.frag"));
  program.use();
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2.0f);
  atlas.bind();
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  for (int i = 0; i < kSky; ++i) {
    gl.Viewport(i % kTilesX * kTile, i / kTilesX * kTile, kTile, kTile);
    gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE,
                        lights.clips[static_cast<std::size_t>(i)].data());
    solids.vertices.draw(casters);
  }
  lamp.bind();
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, lights.lamp_clip.data());
  solids.draw();
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

/// What both passes draw.
struct Drawing {
  const PictureScene& scene;
  const PictureGeometry& geometry;
  const Lights& lights;
  const GlSurface &solids, &ground, &creases;
};

/// Depth first, so that only what is seen is shaded: the sky costs most where beads lie behind beads.
void draw_depth(const GlFunctions& gl, const Mat4f& clip, const Drawing& drawing) {
  const GlProgram program(gl, "depth", shader_source("depth.vert"), shader_source("depth.frag"));
  program.use();
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawing.solids.draw();
  drawing.ground.draw();
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.DepthFunc(GL_LEQUAL);
}

/// Light from the sky on what is seen, in a picture of half the size.
void draw_sky(const GlFunctions& gl, const Drawing& drawing, const GlTarget& atlas, const GlTarget& target) {
  const auto& [scene, g, lights, solids, ground, creases] = drawing;
  const GlProgram program(gl, "sky", shader_source("sky.vert"), shader_source("sky.frag"));
  target.bind();
  const float nothing[] = {1, 1e9f, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  const Mat4f clip = eye_clip(scene, g);
  draw_depth(gl, clip, drawing);
  compare_when_sampled(gl, GL_TEXTURE0, atlas);
  program.use();
  const Eigen::Vector3f eye = (scene.eye_W - g.centre).cast<float>();
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.Uniform3fv(program.uniform("eye"), 1, eye.data());
  gl.Uniform3fv(program.uniform("sky_direction"), kSky, lights.directions.front().data());
  gl.UniformMatrix4fv(program.uniform("sky_clip"), kSky, GL_FALSE, lights.clips.front().data());
  gl.Uniform2i(program.uniform("sky_tiles"), kTilesX, kTilesY);
  gl.Uniform1f(program.uniform("sky_texel"), static_cast<float>(2 * g.radius / kTile));
  gl.Uniform1i(program.uniform("sky_atlas"), 0);
  solids.draw();
  ground.draw();
  gl.DepthFunc(GL_LESS);
}

/// What each pixel shows of the bound target at its farthest sample, when only depth is drawn.
FarthestSeen draw_farthest(const GlFunctions& gl, const Drawing& drawing, const GlSmoothTarget& target) {
  const PictureScene& scene = drawing.scene;
  FarthestSeen seen{scene.width, scene.height, {}};
  draw_depth(gl, eye_clip(scene, drawing.geometry), drawing);
  gl.DepthFunc(GL_LESS);
  const GlTarget farthest(gl, GL_R32F, scene.width, scene.height);
  GlVertices all(gl, {3});
  all.fill({-1, -1, 0, 3, -1, 0, -1, 3, 0});
  const GlProgram program(gl, "farthest", shader_source("corner.vert"), shader_source("farthest.frag"));
  program.use();
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, target.depth());
  gl.Uniform1i(program.uniform("depth"), 0);
  gl.Uniform1i(program.uniform("samples"), target.samples());
  farthest.bind();
  gl.Disable(GL_DEPTH_TEST);
  all.draw(GL_TRIANGLES);
  gl.Enable(GL_DEPTH_TEST);
  seen.depth.resize(static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height));
  gl.ReadPixels(0, 0, seen.width, seen.height, GL_RED, GL_FLOAT, seen.depth.data());
  return seen;
}

void draw_picture(const GlFunctions& gl, const Drawing& drawing, const GlTarget& sky, const GlTarget& lamp) {
  const auto& [scene, g, lights, solids, ground, creases] = drawing;
  const GlProgram program(gl, "scene", shader_source("scene.vert"), shader_source("scene.frag"));
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, sky.colour());
  compare_when_sampled(gl, GL_TEXTURE1, lamp);
  program.use();
  const Mat4f clip = eye_clip(scene, g);
  const Eigen::Vector3f eye = (scene.eye_W - g.centre).cast<float>(), direction = lights.lamp.cast<float>();
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.Uniform3fv(program.uniform("eye"), 1, eye.data());
  gl.Uniform3fv(program.uniform("background"), 1, scene.background.data());
  gl.Uniform1f(program.uniform("ground_fade"), static_cast<float>(g.ground_fade));
  gl.Uniform3fv(program.uniform("lamp_direction"), 1, direction.data());
  gl.UniformMatrix4fv(program.uniform("lamp_clip"), 1, GL_FALSE, lights.lamp_clip.data());
  gl.Uniform1f(program.uniform("lamp_texel"), static_cast<float>(2 * g.radius / kLampMap));
  gl.Uniform1i(program.uniform("sky_light"), 0);
  gl.Uniform1i(program.uniform("lamp_depth"), 1);
  solids.draw();
  creases.draw();
  ground.draw();
}

float encoded(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace

Picture render_picture(PictureScene scene) {
  check(scene);
  eye_axes(scene);
  PictureGeometry geometry = picture_geometry(scene);
  scene.surfaces = {};  // they are large, and in the geometry
  const Lights lights = make_lights(scene, geometry.radius);

  GlContext context;
  const GlFunctions& gl = context.gl();
  GlSurface solids(gl, geometry.solids);
  const GlSurface ground(gl, geometry.ground), creases(gl, geometry.creases);
  std::optional<GlTarget> atlas(std::in_place, gl, GL_R8, kTilesX * kTile, kTilesY * kTile);
  const GlTarget lamp(gl, GL_R8, kLampMap, kLampMap);
  {
    GlTriangles casters(gl);
    casters.fill(std::exchange(geometry.casters, {}));
    draw_shadows(gl, lights, solids, casters, *atlas, lamp);
  }

  const Drawing drawing{scene, geometry, lights, solids, ground, creases};
  const GlSmoothTarget target(gl, scene.width, scene.height);
  target.bind();
  const auto& b = scene.background;
  const float behind[] = {encoded(b[0]), encoded(b[1]), encoded(b[2]), 1};
  gl.ClearBufferfv(GL_COLOR, 0, behind);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  solids.triangles.fill(
      without_hidden(geometry.solids, eye_clip(scene, geometry), draw_farthest(gl, drawing, target)));
  geometry.solids = {};

  const GlTarget half_size(gl, GL_RGBA32F, (scene.width + 1) / 2, (scene.height + 1) / 2);
  draw_sky(gl, drawing, *atlas, half_size);
  atlas.reset();
  target.bind();
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  draw_picture(gl, drawing, half_size, lamp);
  const std::vector<unsigned char> rgba = target.resolve();
  context.check("the picture");

  Picture picture{scene.width, scene.height, {}};
  picture.rgb.reserve(3 * static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
  for (int y = scene.height - 1; y >= 0; --y) {
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) +
                                 static_cast<std::size_t>(x));
      picture.rgb.insert(picture.rgb.end(), &rgba[i], &rgba[i] + 3);
    }
  }
  return picture;
}

}  // namespace understudy::renderer

#include "renderer/scene_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "renderer/gl_context.h"
#include "renderer/hidden_triangles.h"
#include "renderer/scene_drawing.h"
#include "renderer/scene_geometry.h"
#include "renderer/scene_light.h"
#include "renderer/shaders.h"

namespace understudy::renderer {
namespace {

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

/// Depth alone.
void draw_depth(const GlFunctions& gl, const Drawing& drawing) {
  const GlProgram program(gl, "depth", shader_source("depth.vert"), shader_source("depth.frag"));
  program.use();
  const Eigen::Matrix4f clip = eye_clip(drawing.scene, drawing.geometry);
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawing.solids.draw();
  drawing.ground.draw();
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

/// What each pixel shows of the bound target at its farthest sample, when only depth is drawn.
FarthestSeen draw_farthest(const GlFunctions& gl, const Drawing& drawing, const GlSmoothTarget& target) {
  const PictureScene& scene = drawing.scene;
  FarthestSeen seen{scene.width, scene.height, {}};
  draw_depth(gl, drawing);
  const GlTarget farthest(gl, GL_R32F, scene.width, scene.height);
  const GlProgram program(gl, "farthest", shader_source("corner.vert"), shader_source("farthest.frag"));
  program.use();
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, target.depth());
  gl.Uniform1i(program.uniform("depth"), 0);
  gl.Uniform1i(program.uniform("samples"), target.samples());
  farthest.bind();
  draw_all_pixels(gl);
  seen.depth.resize(static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height));
  gl.ReadPixels(0, 0, seen.width, seen.height, GL_RED, GL_FLOAT, seen.depth.data());
  return seen;
}

void draw_picture(const GlFunctions& gl, const Drawing& drawing, const Lights& lights,
                  const GlTarget& light) {
  const auto& [scene, g, solids, ground, creases] = drawing;
  const GlProgram program(gl, "scene", shader_source("scene.vert"), shader_source("scene.frag"));
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, light.colour());
  program.use();
  const Eigen::Matrix4f clip = eye_clip(scene, g);
  const Eigen::Vector3f eye = (scene.eye_W - g.centre).cast<float>(), direction = lights.lamp.cast<float>();
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.Uniform3fv(program.uniform("eye"), 1, eye.data());
  gl.Uniform3fv(program.uniform("background"), 1, scene.background.data());
  gl.Uniform1f(program.uniform("ground_fade"), static_cast<float>(g.ground_fade));
  gl.Uniform3fv(program.uniform("lamp_direction"), 1, direction.data());
  gl.Uniform1i(program.uniform("half_size_light"), 0);
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
  const auto draw_next_without_backs = [&](const Vec3& from, float is_place) {
    Eigen::Vector4f homogeneous;
    homogeneous << from.cast<float>(), is_place;
    solids.triangles.fill(without_backs(geometry.solids, geometry.closed, homogeneous));
  };
  const GlSurface ground(gl, geometry.ground), creases(gl, geometry.creases);
  std::optional<ShadowMaps> shadow_maps(std::in_place, gl);
  {
    GlTriangles casters(gl);
    casters.fill(std::exchange(geometry.casters, {}));
    draw_next_without_backs(lights.lamp, 0);
    shadow_maps->draw(gl, lights, solids, casters);
  }

  const Drawing drawing{scene, geometry, solids, ground, creases};
  const GlSmoothTarget target(gl, scene.width, scene.height);
  target.bind();
  const auto& b = scene.background;
  const float behind[] = {encoded(b[0]), encoded(b[1]), encoded(b[2]), 1};
  gl.ClearBufferfv(GL_COLOR, 0, behind);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  draw_next_without_backs(scene.eye_W - geometry.centre, 1);
  solids.triangles.fill(
      without_hidden(geometry.solids, eye_clip(scene, geometry), draw_farthest(gl, drawing, target)));
  geometry.solids = {};

  const GlTarget half_size(gl, GL_RGBA32F, (scene.width + 1) / 2, (scene.height + 1) / 2);
  draw_light(gl, drawing, lights, *shadow_maps, half_size);
  shadow_maps.reset();
  target.bind();
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  draw_picture(gl, drawing, lights, half_size);
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

#include "renderer/scene_light.h"

#include <cmath>

#include "renderer/shaders.h"

namespace understudy::renderer {
namespace {

constexpr int kSky = 48, kTilesX = 8, kTilesY = 6,
              kTile = 256;  // shadow maps of the sky's lights, in one atlas
constexpr int kLampMap = 2048;

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

/// The lamp stands over the viewer's left shoulder.
Vec3 lamp_direction(const PictureScene& scene) {
  const Mat3 axes = eye_axes(scene);
  const Vec3 direction = axes.transpose() * Vec3(-0.45, 0.35, 0.55) + 0.75 * Vec3::UnitZ();
  return direction.normalized();
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

/// Distance and normal of what each pixel of the bound target shows.
void draw_surface(const GlFunctions& gl, const Drawing& drawing) {
  const float nothing[] = {1e9f, 0, 0, 1};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  const GlProgram program(gl, "surface", shader_source("scene.vert"), shader_source("surface.frag"));
  program.use();
  const Mat4f clip = eye_clip(drawing.scene, drawing.geometry);
  const Eigen::Vector3f eye = (drawing.scene.eye_W - drawing.geometry.centre).cast<float>();
  gl.UniformMatrix4fv(program.uniform("clip"), 1, GL_FALSE, clip.data());
  gl.Uniform3fv(program.uniform("eye"), 1, eye.data());
  drawing.solids.draw();
  drawing.ground.draw();
}

}  // namespace

Lights make_lights(const PictureScene& scene, double radius) {
  Lights lights;
  lights.radius = radius;
  for (const Vec3& direction : sky_directions(kSky)) {
    lights.directions.push_back(direction.cast<float>());
    lights.clips.push_back(light_clip(direction, radius));
  }
  lights.lamp = lamp_direction(scene);
  lights.lamp_clip = light_clip(lights.lamp, radius);
  return lights;
}

ShadowMaps::ShadowMaps(const GlFunctions& gl)
    : sky(gl, GL_R8, kTilesX * kTile, kTilesY * kTile), lamp(gl, GL_R8, kLampMap, kLampMap) {}

void ShadowMaps::draw(const GlFunctions& gl, const Lights& lights, const GlSurface& solids,
                      const GlTriangles& casters) const {
  const GlProgram program(gl, "depth", shader_source("depth.vert"), shader_source("depth.frag"));
  program.use();
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2.0f);
  sky.bind();
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

void draw_light(const GlFunctions& gl, const Drawing& drawing, const Lights& lights, const ShadowMaps& maps,
                const GlTarget& target) {
  const PictureScene& scene = drawing.scene;
  const GlTarget surface(gl, GL_RGBA32F, target.width(), target.height());
  surface.bind();
  draw_surface(gl, drawing);
  const GlProgram program(gl, "light", shader_source("corner.vert"), shader_source("light.frag"));
  target.bind();
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, surface.colour());
  compare_when_sampled(gl, GL_TEXTURE1, maps.sky);
  compare_when_sampled(gl, GL_TEXTURE2, maps.lamp);
  program.use();
  const auto set = [&](const char* name, const Vec3& value) {
    const Eigen::Vector3f v = value.cast<float>();
    gl.Uniform3fv(program.uniform(name), 1, v.data());
  };
  const Mat3 axes = eye_axes(scene);
  const double half_height = std::tan(scene.field_of_view / 2);
  set("eye", scene.eye_W - drawing.geometry.centre);
  set("ahead", -axes.row(2));
  set("across", half_height * scene.width / scene.height * axes.row(0));
  set("upward", half_height * axes.row(1));
  gl.Uniform2f(program.uniform("size"), static_cast<float>(target.width()),
               static_cast<float>(target.height()));
  gl.Uniform3fv(program.uniform("sky_direction"), kSky, lights.directions.front().data());
  gl.UniformMatrix4fv(program.uniform("sky_clip"), kSky, GL_FALSE, lights.clips.front().data());
  gl.Uniform2i(program.uniform("sky_tiles"), kTilesX, kTilesY);
  gl.Uniform1f(program.uniform("sky_texel"), static_cast<float>(2 * lights.radius / kTile));
  gl.UniformMatrix4fv(program.uniform("lamp_clip"), 1, GL_FALSE, lights.lamp_clip.data());
  gl.Uniform1f(program.uniform("lamp_texel"), static_cast<float>(2 * lights.radius / kLampMap));
  gl.Uniform1i(program.uniform("surface"), 0);
  gl.Uniform1i(program.uniform("sky_atlas"), 1);
  gl.Uniform1i(program.uniform("lamp_depth"), 2);
  draw_all_pixels(gl);
}

}  // namespace understudy::renderer

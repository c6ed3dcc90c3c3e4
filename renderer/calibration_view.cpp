#include "renderer/calibration_view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "renderer/gl_context.h"
#include "renderer/sensor.h"
#include "renderer/shaders.h"

namespace understudy::renderer {
namespace {

constexpr std::size_t kMostSpheres = 8;                 // of the shader's array
constexpr std::uint64_t kCameraNoise = 0x63616D657261;  // key of hash_bits

void check(bool good, const std::string& quantity, double value, const char* limit) {
  if (!good) {
    throw InputError("calibration view: " + quantity + " is " + std::to_string(value) + ", must be " + limit);
  }
}

void check(const Camera& c, const Exposure& e) {
  check(c.width > 0 && c.width <= 8192, "camera width [px]", c.width, "in 1..8192");
  check(c.height > 0 && c.height <= 8192, "camera height [px]", c.height, "in 1..8192");
  check(c.focal_px > 0 && std::isfinite(c.focal_px), "focal length [px]", c.focal_px, "positive");
  // The shader removes distortion by a fixed point: beyond this it does not converge to 1e-4 px.
  const Vec2 far = Vec2(c.width, c.height).cwiseProduct(Vec2(0.5, 0.5)) +
                   (c.centre_px - Vec2(0.5 * c.width, 0.5 * c.height)).cwiseAbs();
  const double r2 = far.squaredNorm() / (c.focal_px * c.focal_px);
  const double bend = 3 * std::abs(c.k1) * r2 + 5 * std::abs(c.k2) * r2 * r2 +
                      6 * (std::abs(c.p1) + std::abs(c.p2)) * std::sqrt(r2);
  check(bend < 0.2, "lens distortion's slope in the picture's corner", bend, "below 0.2");
  check(e.blur_px >= 0.3 && e.blur_px <= 10, "blur [px]", e.blur_px, "in 0.3..10");
  check(e.gain >= 0 && e.gain <= 1e4, "gain [grey levels]", e.gain, "in 0..1e4");
  check(e.ambient_level >= 0 && e.ambient_level <= 1e4, "ambient level", e.ambient_level, "in 0..1e4");
  check(e.full_well >= 0, "full well [electrons]", e.full_well, "0 or more");
  check(e.read_noise >= 0, "read noise [electrons]", e.read_noise, "0 or more");
}

void check(const BoardScene& s) {
  check(s.camera, s.exposure);
  check(s.columns >= 2 && s.columns <= 200, "board columns", s.columns, "in 2..200");
  check(s.rows >= 2 && s.rows <= 200, "board rows", s.rows, "in 2..200");
  check(s.square > 0, "board square [m]", s.square, "positive");
  check(s.margin >= 0, "board margin [m]", s.margin, "0 or more");
  check(s.X_CG.matrix().allFinite(), "board pose", s.X_CG.translation().x(), "finite");
  const double squares_px = s.camera.focal_px * s.square / std::max(s.X_CG.translation().z(), 1e-9);
  check(squares_px > 12 * s.exposure.blur_px, "board square [px]", squares_px, "above 12 blurs");
}

void check(const TargetScene& s) {
  check(s.camera, s.exposure);
  check(s.radius > 0, "target radius [m]", s.radius, "positive");
  check(!s.centres_C.empty() && s.centres_C.size() <= kMostSpheres, "number of targets",
        static_cast<double>(s.centres_C.size()), "in 1..8");
  for (const Vec3& c : s.centres_C)
    check(c.z() > 2 * s.radius, "target distance [m]", c.z(), "above a diameter");
}

/// Ray (x, y, 1) of the camera to the board's plane, in squares from the outer corner of the first square.
Mat3 ray_to_squares(const BoardScene& s) {
  const Mat3 R = s.X_CG.linear() * s.square;
  const Vec3 first = s.X_CG.translation() - R.col(0) * 0.5 * (s.columns + 1) - R.col(1) * 0.5 * (s.rows + 1);
  Mat3 from_squares;
  from_squares << R.col(0), R.col(1), first;
  return from_squares.inverse();
}

/// Directions of the camera to the sheet's: x and y in squares, z in metres.
Mat3 camera_to_sheet(const BoardScene& s) {
  return Vec3(1 / s.square, 1 / s.square, 1).asDiagonal() * s.X_CG.linear().transpose();
}

}  // namespace

struct CalibrationView::State {
  GlContext context;
  GlProgram program{context.gl(), "calibration", shader_source("calibration.vert"),
                    shader_source("calibration.frag")};
  GlVertices triangle{context.gl(), {2}};
  std::unique_ptr<GlTarget> target;

  void aim(const Camera& camera, const Exposure& exposure, double albedo, double background,
           const Region& region);
  Image shoot(const Camera& camera, const Exposure& exposure, const Region& region);
};

void CalibrationView::State::aim(const Camera& camera, const Exposure& exposure, double albedo,
                                 double background, const Region& region) {
  const GlFunctions& gl = context.gl();
  const auto put = [&](const char* name, double a, double b, double c, double d) {
    gl.Uniform4f(program.uniform(name), static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
                 static_cast<float>(d));
  };
  context.make_current();
  program.use();
  put("lens", camera.focal_px, camera.centre_px.x(), camera.centre_px.y(), exposure.blur_px);
  put("brown", camera.k1, camera.k2, camera.p1, camera.p2);
  put("light", exposure.gain, exposure.ambient_level, albedo, background);
  gl.Uniform2f(program.uniform("origin"), static_cast<float>(region.x), static_cast<float>(region.y));
}

Image CalibrationView::State::shoot(const Camera& camera, const Exposure& exposure, const Region& region) {
  const GlFunctions& gl = context.gl();
  if (!target || target->width() != region.width || target->height() != region.height) {
    target.reset();
    target = std::make_unique<GlTarget>(gl, GL_R32F, region.width, region.height);
  }
  target->bind();
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_SCISSOR_TEST);
  triangle.fill({-1, -1, 3, -1, -1, 3});
  triangle.draw(GL_TRIANGLES);
  std::vector<float> levels(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.ReadPixels(0, 0, region.width, region.height, GL_RED, GL_FLOAT, levels.data());
  context.check("the calibration view");
  const SensorNoise noise{exposure.full_well, exposure.read_noise,
                          hash_bits(exposure.seed ^ kCameraNoise, exposure.frame)};
  return digitise(levels, region, camera.width, exposure.noise ? &noise : nullptr);
}

CalibrationView::CalibrationView() : state_(std::make_unique<State>()) {}

CalibrationView::~CalibrationView() {
  if (state_) state_->context.make_current();  // the objects' owner must be current when they go
}

Image CalibrationView::render(const BoardScene& scene, const Region& region) {
  check(scene);
  const Region read_out = clipped(region, scene.camera.sensor());
  if (read_out.width == 0 || read_out.height == 0) return Image{{read_out.x, read_out.y, 0, 0}, {}};
  State& s = *state_;
  s.aim(scene.camera, scene.exposure, scene.ink, scene.background, read_out);
  const GlFunctions& gl = s.context.gl();
  const Eigen::Matrix3f to_grid = ray_to_squares(scene).cast<float>();
  gl.Uniform1i(s.program.uniform("spheres"), 0);
  gl.UniformMatrix3fv(s.program.uniform("to_grid"), 1, GL_FALSE, to_grid.data());
  const Eigen::Matrix3f to_sheet = camera_to_sheet(scene).cast<float>();
  gl.UniformMatrix3fv(s.program.uniform("to_sheet"), 1, GL_FALSE, to_sheet.data());
  gl.Uniform3f(s.program.uniform("bow"), static_cast<float>(scene.bow.x()), static_cast<float>(scene.bow.y()),
               static_cast<float>(scene.bow.z()));
  gl.Uniform3f(s.program.uniform("sheet"), static_cast<float>(scene.columns + 1),
               static_cast<float>(scene.rows + 1), static_cast<float>(scene.margin / scene.square));
  return s.shoot(scene.camera, scene.exposure, read_out);
}

Image CalibrationView::render(const TargetScene& scene, const Region& region) {
  check(scene);
  const Region read_out = clipped(region, scene.camera.sensor());
  if (read_out.width == 0 || read_out.height == 0) return Image{{read_out.x, read_out.y, 0, 0}, {}};
  State& s = *state_;
  s.aim(scene.camera, scene.exposure, scene.albedo, 1, read_out);
  const GlFunctions& gl = s.context.gl();
  std::vector<Vec3> centres = scene.centres_C;
  std::sort(centres.begin(), centres.end(), [](const Vec3& a, const Vec3& b) { return a.z() > b.z(); });
  std::vector<float> values;
  for (const Vec3& c : centres) {
    for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(c[i]));
  }
  gl.Uniform1i(s.program.uniform("spheres"), static_cast<int>(centres.size()));
  gl.Uniform3fv(s.program.uniform("centre"), static_cast<int>(centres.size()), values.data());
  gl.Uniform1f(s.program.uniform("radius"), static_cast<float>(scene.radius));
  return s.shoot(scene.camera, scene.exposure, read_out);
}

}  // namespace understudy::renderer

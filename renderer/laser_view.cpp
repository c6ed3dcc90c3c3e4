#include "renderer/laser_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/random.h"
#include "renderer/gl_context.h"
#include "renderer/lens.h"
#include "renderer/sensor.h"
#include "renderer/shaders.h"
#include "renderer/speckle.h"
#include "renderer/tessellate.h"

namespace understudy::renderer {
namespace {

constexpr int kShadowCells = 256;
constexpr int kSegments = 128;            // chord error of a nozzle of 1 mm: 0.3 um
constexpr double kBeamReach = 2.2;        // radii; beyond, less than 1e-4 of the peak
constexpr double kNear = 2e-3, kFar = 1;  // [m] before the camera
constexpr double kTableHalf = 0.25;       // [m] of the table around the tool
constexpr float kToolAlbedo = 0.6f;       // brass and steel, relative to matt plastic
const std::vector<int> kViewLayout = {3, 3, 4, 1};
constexpr std::uint64_t kRoughness = 0x726F756768, kShot = 0x73686F74;  // key the streams of hash_bits

void check(bool good, const char* quantity, double value, const char* limit) {
  if (!good) {
    throw InputError(std::string("laser scene: ") + quantity + " is " + std::to_string(value) + ", must be " +
                     limit);
  }
}

void check(const LaserScene& s) {
  check(s.camera.width > 0 && s.camera.width <= 8192, "camera width [px]", s.camera.width, "in 1..8192");
  check(s.camera.height > 0 && s.camera.height <= 8192, "camera height [px]", s.camera.height, "in 1..8192");
  check(s.camera.focal_px > 0, "focal length [px]", s.camera.focal_px, "positive");
  check(s.waist_diameter > 0, "laser waist diameter [m]", s.waist_diameter, "positive");
  check(s.blur_px >= 0 && s.blur_px <= 50, "blur [px]", s.blur_px, "in 0..50");
  check(s.peak_level >= 0, "laser peak level", s.peak_level, "0 or more");
  check(s.ambient_level >= 0, "ambient level", s.ambient_level, "0 or more");
  check(s.full_well >= 0, "full well [electrons]", s.full_well, "0 or more");
  check(s.read_noise >= 0, "read noise [electrons]", s.read_noise, "0 or more");
  check(!s.speckle || (s.aperture_sine >= 0.002 && s.aperture_sine < 1), "aperture sine", s.aperture_sine,
        "in 0.002..1 for speckle");
  check(!s.speckle || s.wavelength > 0, "wavelength [m]", s.wavelength, "positive for speckle");
  check(s.X_WT.matrix().allFinite(), "tool pose", s.X_WT.translation().x(), "finite");
}

/// The beam in some frame: two axes across it, its direction, and the point of its axis nearest to the tip,
/// so that coordinates near the dot are small.
struct Beam {
  Vec3 point;
  Mat3 axes;
  double source = 0;  ///< [m], of the laser before that point
};

Beam beam_in(const Pose& X_FT, const Pose& X_TL) {
  const Vec3 direction_T = X_TL.linear().col(2);
  const double source = -X_TL.translation().dot(direction_T);
  return {X_FT * (X_TL.translation() + source * direction_T), X_FT.linear() * X_TL.linear(), source};
}

/// The table's tangent plane below a place: within the picture's millimetres a bow differs by nanometres.
Surface table_around(const geometry::TableSurface& top, const Vec3& p_W) {
  const Vec2 middle = p_W.head<2>();
  const Vec3 normal = top.normal(middle);
  Surface s;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    const Vec2 corner = middle + kTableHalf * Vec2(x, y);
    const Vec2 way = corner.cwiseMax(-top.half_sides).cwiseMin(top.half_sides) - middle;
    const double rise = -normal.head<2>().dot(way) / normal.z();
    s.vertices.push_back({middle.x() + way.x(), middle.y() + way.y(), top.z(middle) + rise});
  }
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.corner_normals.assign(2, {normal, normal, normal});
  return s;
}

void put(std::vector<float>& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.push_back(static_cast<float>(v[i]));
}

}  // namespace

struct LaserView::State {
  GlContext context;
  GlProgram view{context.gl(), "laser", shader_source("laser.vert"), shader_source("laser.frag")};
  GlProgram shadow{context.gl(), "beam", shader_source("beam.vert"), shader_source("beam.frag")};
  GlVertices view_vertices{context.gl(), kViewLayout};
  GlVertices shadow_vertices{context.gl(), {3}};
  GlTarget blockers{context.gl(), GL_R32F, kShadowCells, kShadowCells};
  std::optional<GlTarget> target;
  std::optional<Lens> lens;
  // Meshes are large and stay the same from frame to frame; holding them keeps their addresses theirs.
  std::map<std::shared_ptr<const geometry::Mesh>, Surface> meshes;
  std::vector<float> view_data, shadow_data;
  SampleGrid seen;  // of the newest frame; megabytes, which every frame would ask the system for

  const Surface& surface_of(const std::shared_ptr<const geometry::Mesh>& mesh) {
    if (meshes.size() > 8) meshes.clear();
    const auto [entry, is_new] = meshes.try_emplace(mesh);
    if (is_new) entry->second = tessellate(*mesh);
    return entry->second;
  }

  void prepare(const LaserScene& scene, int margin);
  void gather(const LaserScene& scene, const Region& region);
  void add(const Surface& surface, const Pose& X_CF, Owner owner, const LaserScene& scene,
           const Region& region);
  void draw_blockers(const LaserScene& scene);
  void draw_view(const LaserScene& scene, const Region& samples);
};

void LaserView::State::prepare(const LaserScene& scene, int margin) {
  if (lens && lens->matches(scene.camera, margin)) return;
  lens.emplace(scene.camera, margin);
  target.reset();
  // Large enough for the pinhole's picture of the whole sensor and its margin.
  const Region sensor{-margin, -margin, scene.camera.width + 2 * margin, scene.camera.height + 2 * margin};
  const Region samples = lens->ideal_samples(sensor);
  const int border =
      std::max({-samples.x, -samples.y, samples.x + samples.width - kSamplesPerPixel * scene.camera.width,
                samples.y + samples.height - kSamplesPerPixel * scene.camera.height});
  check(border < kSamplesPerPixel * (scene.camera.width + scene.camera.height), "lens distortion k1",
        scene.camera.k1, "small enough for every pixel to have a ray");
  const int width = kSamplesPerPixel * scene.camera.width + 2 * border;
  const int height = kSamplesPerPixel * scene.camera.height + 2 * border;
  target.emplace(context.gl(), GL_RGBA32F, width, height);
}

/// Triangles that can be seen in `region` go to the view, those that the beam can meet to the shadow map.
void LaserView::State::add(const Surface& surface, const Pose& X_CF, Owner owner, const LaserScene& scene,
                           const Region& region) {
  const Pose X_CT = scene.X_TC.inverse();
  const Beam beam = beam_in(X_CT, scene.X_TL);
  const double reach = kBeamReach * scene.waist_diameter / 2;
  const Vec2 low = (Vec2(region.x, region.y) - scene.camera.centre_px) / scene.camera.focal_px;
  const Vec2 high = (Vec2(region.x + region.width, region.y + region.height) - scene.camera.centre_px) /
                    scene.camera.focal_px;

  std::vector<Vec3> p_C(surface.vertices.size()), p_beam(surface.vertices.size());
  for (std::size_t i = 0; i < p_C.size(); ++i) {
    p_C[i] = X_CF * surface.vertices[i];
    p_beam[i] = beam.axes.transpose() * (p_C[i] - beam.point);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto ia = static_cast<std::size_t>(a), ib = static_cast<std::size_t>(b),
               ic = static_cast<std::size_t>(c);
    const Vec3 least = p_beam[ia].cwiseMin(p_beam[ib]).cwiseMin(p_beam[ic]);
    const Vec3 most = p_beam[ia].cwiseMax(p_beam[ib]).cwiseMax(p_beam[ic]);
    if (least.x() <= reach && least.y() <= reach && most.x() >= -reach && most.y() >= -reach) {
      for (const std::size_t i : {ia, ib, ic}) put(shadow_data, p_beam[i]);
    }

    const auto all_corners = [&](const auto& outside) {
      return outside(p_C[ia]) && outside(p_C[ib]) && outside(p_C[ic]);
    };
    if (all_corners([](const Vec3& p) { return p.z() < kNear; }) ||
        all_corners([&](const Vec3& p) { return p.x() < low.x() * p.z(); }) ||
        all_corners([&](const Vec3& p) { return p.x() > high.x() * p.z(); }) ||
        all_corners([&](const Vec3& p) { return p.y() < low.y() * p.z(); }) ||
        all_corners([&](const Vec3& p) { return p.y() > high.y() * p.z(); })) {
      continue;
    }
    const Vec3 normal = (p_C[ib] - p_C[ia]).cross(p_C[ic] - p_C[ia]);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) continue;
    const auto& corner_normals = surface.corner_normals[t];
    std::size_t k = 0;
    for (const std::size_t i : {ia, ib, ic}) {
      put(view_data, p_C[i]);
      put(view_data, X_CF.linear() * corner_normals[k++]);
      put(view_data, normal / twice_area);
      view_data.push_back(static_cast<float>(normal.dot(p_C[ia]) / twice_area));
      view_data.push_back(static_cast<float>(owner));
    }
  }
}

void LaserView::State::gather(const LaserScene& scene, const Region& region) {
  view_data.clear();
  shadow_data.clear();
  const Pose X_CT = scene.X_TC.inverse();
  const Pose X_CW = (scene.X_WT * scene.X_TC).inverse();
  if (scene.part) add(surface_of(scene.part), X_CW, Owner::scenery, scene, region);
  if (scene.printed) add(tessellate(*scene.printed), X_CW, Owner::scenery, scene, region);  // grows: not kept
  for (const auto& body : scene.tool_bodies) {
    const auto* mesh = std::get_if<geometry::MeshShape>(&body.form);
    if (mesh) {
      add(surface_of(mesh->mesh), X_CT * body.X_FS, Owner::tool, scene, region);
    } else {
      add(tessellate(body, kSegments), X_CT, Owner::tool, scene, region);
    }
  }
  if (scene.table && scene.table_top.reaches(scene.X_WT.translation().head<2>()))
    add(table_around(scene.table_top, scene.X_WT.translation()), X_CW, Owner::scenery, scene, region);
}

void LaserView::State::draw_blockers(const LaserScene& scene) {
  const GlFunctions& gl = context.gl();
  const Beam beam = beam_in(Pose::Identity(), scene.X_TL);
  blockers.bind();
  gl.Disable(GL_SCISSOR_TEST);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  const float nothing[] = {1e3f, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  shadow.use();
  gl.Uniform1f(shadow.uniform("reach"), static_cast<float>(kBeamReach * scene.waist_diameter / 2));
  // What lies behind the laser blocks nothing.
  gl.Uniform2f(shadow.uniform("near_far"), static_cast<float>(-beam.source), static_cast<float>(kFar));
  shadow_vertices.fill(shadow_data);
  shadow_vertices.draw(GL_TRIANGLES);
}

/// Into `seen`.
void LaserView::State::draw_view(const LaserScene& scene, const Region& samples) {
  const GlFunctions& gl = context.gl();
  const int border_x = (target->width() - kSamplesPerPixel * scene.camera.width) / 2;
  const int border_y = (target->height() - kSamplesPerPixel * scene.camera.height) / 2;
  target->bind();
  // The viewport is the whole sensor's whatever the region: equal fragments get equal values.
  gl.Enable(GL_SCISSOR_TEST);
  gl.Scissor(samples.x + border_x, samples.y + border_y, samples.width, samples.height);
  const float nothing[] = {0, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  gl.Clear(GL_DEPTH_BUFFER_BIT);

  const Beam beam = beam_in(scene.X_TC.inverse(), scene.X_TL);
  const double reach = kBeamReach * scene.waist_diameter / 2;
  view.use();
  // In the target's window coordinates, sample (i, j) has its centre at i + border + 1/2.
  gl.Uniform4f(view.uniform("lens"), static_cast<float>(kSamplesPerPixel * scene.camera.focal_px),
               static_cast<float>(sample_of_pixel(scene.camera.centre_px.x()) + border_x + 0.5),
               static_cast<float>(sample_of_pixel(scene.camera.centre_px.y()) + border_y + 0.5), 0.0f);
  gl.Uniform2f(view.uniform("size"), static_cast<float>(target->width()),
               static_cast<float>(target->height()));
  gl.Uniform2f(view.uniform("near_far"), static_cast<float>(kNear), static_cast<float>(kFar));
  const Eigen::Vector3f point = beam.point.cast<float>();
  const Eigen::Matrix3f axes = beam.axes.cast<float>();
  gl.Uniform3fv(view.uniform("axis_point"), 1, point.data());
  gl.UniformMatrix3fv(view.uniform("beam"), 1, GL_FALSE, axes.data());
  gl.Uniform1f(view.uniform("radius"), static_cast<float>(scene.waist_diameter / 2));
  gl.Uniform1f(view.uniform("reach"), static_cast<float>(reach));
  gl.Uniform1f(view.uniform("peak"), static_cast<float>(scene.peak_level));
  gl.Uniform1f(view.uniform("ambient"), static_cast<float>(scene.ambient_level));
  gl.Uniform1f(view.uniform("tool_albedo"), kToolAlbedo);
  gl.Uniform1i(view.uniform("blockers"), 0);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, blockers.colour());
  view_vertices.fill(view_data);
  view_vertices.draw(GL_TRIANGLES);

  seen.x = samples.x, seen.y = samples.y, seen.width = samples.width, seen.height = samples.height;
  const std::size_t count =
      static_cast<std::size_t>(samples.width) * static_cast<std::size_t>(samples.height);
  if (seen.samples.size() < count) seen.samples.resize(count);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.ReadPixels(samples.x + border_x, samples.y + border_y, samples.width, samples.height, GL_RGBA, GL_FLOAT,
                seen.samples.data());
  context.check("the laser view");
}

struct LaserView::Kept {
  bool keeps = false;
  std::unique_ptr<State> state;

  ~Kept() {
    if (state) state->context.make_current();
  }
  static Kept& of_thread() {
    thread_local Kept kept;
    return kept;
  }
};

LaserView::LaserView() : state_(std::move(Kept::of_thread().state)) {
  if (!state_) state_ = std::make_unique<State>();
}

LaserView::~LaserView() {
  if (!state_) return;
  state_->context.make_current();  // the objects' owner must be current when they go
  Kept& kept = Kept::of_thread();
  if (!kept.keeps || kept.state) return;
  state_->meshes.clear();
  kept.state = std::move(state_);
}

void keep_laser_views() { LaserView::Kept::of_thread().keeps = true; }

Image LaserView::render(const LaserScene& scene, const Region& region) {
  check(scene);
  const Region read_out = clipped(region, scene.camera.sensor());
  if (read_out.width == 0 || read_out.height == 0) return Image{{read_out.x, read_out.y, 0, 0}, {}};
  State& s = *state_;
  s.context.make_current();

  const Pose X_WC = scene.X_WT * scene.X_TC;
  const double tip_depth = scene.X_TC.inverse().translation().z();
  const SpeckleOptics optics{scene.wavelength,
                             scene.aperture_sine,
                             scene.camera.focal_px,
                             tip_depth,
                             X_WC,
                             scene.X_TC,
                             hash_bits(scene.seed, kRoughness)};
  if (!(tip_depth > kNear)) throw InputError("laser scene: the tip is not before the camera");
  const int margin = blur_margin(scene.blur_px) + (scene.speckle ? speckle_margin(optics) : 0) + 1;
  s.prepare(scene, margin);

  const Region around{read_out.x - margin, read_out.y - margin, read_out.width + 2 * margin,
                      read_out.height + 2 * margin};
  const Region ideal = s.lens->ideal_samples(around);
  const Region seen_pixels{static_cast<int>(std::floor(pixel_of_sample(ideal.x))) - 1,
                           static_cast<int>(std::floor(pixel_of_sample(ideal.y))) - 1,
                           ideal.width / kSamplesPerPixel + 3, ideal.height / kSamplesPerPixel + 3};
  s.gather(scene, seen_pixels);
  s.draw_blockers(scene);
  s.draw_view(scene, ideal);
  SampleGrid distorted;
  if (s.lens->distorts()) {
    distorted = through_lens(s.seen, *s.lens,
                             {kSamplesPerPixel * around.x, kSamplesPerPixel * around.y,
                              kSamplesPerPixel * around.width, kSamplesPerPixel * around.height});
  }
  SampleGrid& grid = s.lens->distorts() ? distorted : s.seen;
  if (scene.speckle) apply_speckle(grid, *s.lens, optics);
  const SensorNoise noise{scene.full_well, scene.read_noise,
                          hash_bits(hash_bits(scene.seed, kShot), scene.frame)};
  return digitise(integrate(grid, read_out, scene.blur_px), read_out, scene.camera.width,
                  scene.noise ? &noise : nullptr);
}

}  // namespace understudy::renderer

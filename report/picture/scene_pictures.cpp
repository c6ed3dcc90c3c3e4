#include "report/picture/scene_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "sim/surface/bead_sweep.h"

namespace understudy::report {
namespace {

using Colour = std::array<float, 3>;
constexpr Colour kMetal{0.55f, 0.58f, 0.62f}, kStrut{0.25f, 0.42f, 0.62f}, kBrass{0.80f, 0.60f, 0.22f},
    kPart{0.86f, 0.88f, 0.84f}, kTable{0.90f, 0.90f, 0.91f}, kPath{0.85f, 0.25f, 0.10f},
    kHeater{0.45f, 0.20f, 0.18f}, kFilament{0.90f, 0.45f, 0.15f};

Colour colour_of(const std::string& body) {
  if (body.find("strut") != std::string::npos) return kStrut;
  if (body == "nozzle") return kBrass;
  if (body == "heater block") return kHeater;
  return kMetal;
}

/// What a picture of beads can hold; a larger print is drawn coarser.
constexpr std::size_t kTrianglesMost = 1'500'000;
constexpr std::array kTolerances{2e-6, 10e-6, 30e-6, 100e-6, 300e-6};  // [m], the first is that of a close-up

struct Printed {
  renderer::ColouredShape shape;
  double within = 0;       ///< [m], by which it may be off in all: middle lines, sections, corners, chords
  std::size_t one_of = 1;  ///< stretch is drawn
};

/// What was laid by a time.
std::optional<Printed> printed_shape(const sim::BeadIndex& beads, double by = HUGE_VAL) {
  std::vector<sim::BeadStretch> stretches;
  double tolerance = 0;
  std::size_t triangles = 0;
  const auto sides = [&](const sim::BeadStretch& stretch) {
    return sim::sides_within(stretch, 1.3 * tolerance);
  };
  for (const double t : kTolerances) {
    tolerance = t;
    stretches = sim::sweep_beads(beads, {by, t});
    triangles = 0;
    for (const auto& stretch : stretches) triangles += sim::sweep_size(stretch, sides(stretch)).triangles;
    if (triangles <= kTrianglesMost) break;
  }
  const std::size_t stride = triangles / kTrianglesMost + 1;
  sim::BeadMesh shells;
  for (std::size_t i = 0; i < stretches.size(); i += stride)
    sim::append_sweep(stretches[i], sides(stretches[i]), shells);
  if (shells.triangles.empty()) return std::nullopt;
  const auto mesh = std::make_shared<geometry::Mesh>(std::move(shells.vertices), std::move(shells.triangles));
  return Printed{{{"printed", geometry::MeshShape{mesh}}, kFilament, false}, 3.3 * tolerance, stride};
}

constexpr std::size_t kPathPointsMost = 3000;

/// Where axes move the table, the machine stands level and the table is tilted.
void stand_level(const Pose& X_WO, renderer::PictureScene& drawn) {
  const Pose X_OW = X_WO.inverse(Eigen::Isometry);
  for (auto& shape : drawn.shapes) shape.shape.X_FS = X_OW * shape.shape.X_FS;
  for (auto& line : drawn.polylines)
    for (Vec3& point : line.points) point = X_OW * point;
}

renderer::PictureScene build_scene(const rehearsal::Scene& scene) {
  renderer::PictureScene drawn;
  for (const auto& shape : scene.bodies) drawn.shapes.push_back({shape, colour_of(shape.name)});
  drawn.shapes.push_back({scene.table, kTable});
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  if (scene.printed)
    if (auto printed = printed_shape(scene.printed->beads(), scene.time))
      drawn.shapes.push_back(printed->shape);
  // What is still to come, as a thin line; of a very long program its next stretches.
  std::size_t points = 0;
  for (const auto& line : scene.path) {
    if ((points += line.size()) > kPathPointsMost) break;
    drawn.polylines.push_back({line, kPath, 0.05e-3});
  }
  if (scene.X_WO) stand_level(*scene.X_WO, drawn);
  return drawn;
}

struct Ball {
  Vec3 centre;
  double radius;
};

/// Of the middles of all bodies, and the table's corners.
Ball enclose(const renderer::PictureScene& scene) {
  Eigen::AlignedBox3d box;
  for (const auto& shape : scene.shapes) box.extend(Vec3(shape.shape.X_FS.translation()));
  box.extend(Vec3(-0.08, -0.08, 0)).extend(Vec3(0.08, 0.08, 0));
  return {box.center(), 0.5 * box.diagonal().norm()};
}

/// What was laid, without the machine.
std::optional<Illustration> draw_printed_part(const rehearsal::Scene& scene) {
  const sim::BeadIndex& beads = scene.printed->beads();
  const auto printed = printed_shape(beads);
  if (!printed) return std::nullopt;
  const auto& mesh = *std::get<geometry::MeshShape>(printed->shape.shape.form).mesh;
  renderer::PictureScene drawn;
  drawn.shapes.push_back(printed->shape);
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  drawn.target_W = 0.5 * (mesh.lower() + mesh.upper());
  const double radius = std::max(3e-3, 0.5 * (mesh.upper() - mesh.lower()).norm());
  drawn.field_of_view = from_deg(26);
  drawn.eye_W = drawn.target_W + 4.6 * radius * Vec3(0.55, -0.70, 0.45).normalized();
  std::string caption =
      fmt::format("As printed: {} beads, drawn to within {:.0f} µm", beads.size(), to_um(printed->within));
  if (printed->one_of > 1) caption += fmt::format(", one stretch of {}", printed->one_of);
  return Illustration{renderer::render_picture(drawn), caption};
}

renderer::Picture from_afar(renderer::PictureScene drawn) {
  const Ball around = enclose(drawn);
  drawn.target_W = around.centre;
  drawn.eye_W = around.centre + 3.5 * around.radius * Vec3(0.62, -0.74, 0.24).normalized();
  drawn.field_of_view = from_deg(30);
  return renderer::render_picture(drawn);
}

}  // namespace

renderer::Picture draw_overview(const rehearsal::Scene& scene) { return from_afar(build_scene(scene)); }

std::vector<Illustration> draw_scene(const rehearsal::Scene& scene) {
  std::vector<Illustration> pictures;
  renderer::PictureScene near = build_scene(scene);
  pictures.push_back({from_afar(near), scene.simulated ? "Machine and part at the middle of the print"
                                                       : "Machine at home; nothing was simulated"});
  const Vec3 tip = scene.X_WO ? Vec3(scene.X_WO->inverse(Eigen::Isometry) * scene.X_WT.translation())
                              : Vec3(scene.X_WT.translation());
  near.target_W = tip + Vec3(0, 0, 2e-3);
  near.eye_W = near.target_W + Vec3(0.055, -0.075, 0.028);
  near.field_of_view = from_deg(26);
  pictures.push_back({renderer::render_picture(near), "The tool on the path"});
  if (scene.printed && scene.printed->beads().size() > 0)
    if (auto printed = draw_printed_part(scene)) pictures.push_back(std::move(*printed));
  return pictures;
}

}  // namespace understudy::report

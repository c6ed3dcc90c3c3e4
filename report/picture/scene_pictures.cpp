#include "report/picture/scene_pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "report/picture/joined_beads.h"
#include "sim/surface/bead_mesh.h"

namespace understudy::report {
namespace {

using Colour = std::array<float, 3>;
constexpr std::size_t kBeadsDrawn = 15'000;
constexpr Colour kMetal{0.55f, 0.58f, 0.62f}, kStrut{0.25f, 0.42f, 0.62f}, kBrass{0.80f, 0.60f, 0.22f},
    kPart{0.86f, 0.88f, 0.84f}, kTable{0.90f, 0.90f, 0.91f}, kPath{0.85f, 0.25f, 0.10f},
    kHeater{0.45f, 0.20f, 0.18f}, kFilament{0.90f, 0.45f, 0.15f};

Colour colour_of(const std::string& body) {
  if (body.find("strut") != std::string::npos) return kStrut;
  if (body == "nozzle") return kBrass;
  if (body == "heater block") return kHeater;
  return kMetal;
}

/// More points of path than this are drawn as what was printed instead.
constexpr std::size_t kPathPointsMost = 3000;

bool path_is_short(const rehearsal::Scene& scene) {
  std::size_t moves = 0;
  for (const auto& line : scene.path) moves += line.size() - 1;
  return moves <= kPathPointsMost;
}

/// What was laid by a time; of a very large print evenly chosen pieces.
std::optional<renderer::ColouredShape> printed_shape(const sim::BeadIndex& beads, double by = HUGE_VAL) {
  const std::vector<sim::Bead> pieces = joined_beads(beads, by);
  const std::size_t stride = pieces.size() / kBeadsDrawn + 1;
  sim::BeadMesh shells;
  for (std::size_t i = 0; i < pieces.size(); i += stride)
    sim::append_shell(pieces[i], pieces.size() > kPathPointsMost ? 4 : 8, shells);
  if (shells.triangles.empty()) return std::nullopt;
  const auto mesh = std::make_shared<geometry::Mesh>(std::move(shells.vertices), std::move(shells.triangles));
  return renderer::ColouredShape{{"printed", geometry::MeshShape{mesh}}, kFilament, false};
}

renderer::PictureScene build_scene(const rehearsal::Scene& scene) {
  renderer::PictureScene drawn;
  for (const auto& shape : scene.bodies) drawn.shapes.push_back({shape, colour_of(shape.name)});
  drawn.shapes.push_back({scene.table, kTable});
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  if (path_is_short(scene)) {
    for (const auto& line : scene.path) drawn.polylines.push_back({line, kPath, 0.12e-3});
  } else if (scene.printed) {
    if (auto shape = printed_shape(scene.printed->beads(), scene.time)) drawn.shapes.push_back(*shape);
  }
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
  const auto shape = printed_shape(beads);
  if (!shape) return std::nullopt;
  const auto& mesh = *std::get<geometry::MeshShape>(shape->shape.form).mesh;
  renderer::PictureScene drawn;
  drawn.shapes.push_back(*shape);
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  drawn.target_W = 0.5 * (mesh.lower() + mesh.upper());
  const double radius = std::max(3e-3, 0.5 * (mesh.upper() - mesh.lower()).norm());
  drawn.field_of_view = from_deg(26);
  drawn.eye_W = drawn.target_W + 4.6 * radius * Vec3(0.55, -0.70, 0.45).normalized();
  return Illustration{renderer::render_picture(drawn), fmt::format("As printed: {} beads", beads.size())};
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
  near.target_W = scene.X_WT.translation() + Vec3(0, 0, 2e-3);
  near.eye_W = near.target_W + Vec3(0.055, -0.075, 0.028);
  near.field_of_view = from_deg(26);
  pictures.push_back({renderer::render_picture(near), "The tool on the path"});
  if (scene.printed && scene.printed->beads().size() > 0)
    if (auto printed = draw_printed_part(scene)) pictures.push_back(std::move(*printed));
  return pictures;
}

}  // namespace understudy::report

#include "report/picture/scene_pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/process/memory.h"
#include "core/units.h"
#include "report/picture/bead_surface.h"
#include "report/picture/body_colours.h"
#include "report/picture/png.h"
#include "sim/surface/bead_sweep.h"
#include "sim/surface/swept_shell.h"

namespace understudy::report {
namespace {

/// What a picture of beads can hold; a larger print is drawn coarser.
constexpr std::size_t kTrianglesMost = 600'000;
/// Middle lines, sections, corners and chords together are off by no more than so many tolerances.
constexpr double kOffMost = 3.3;

struct Printed {
  renderer::SmoothSurface surface;
  double within = 0;       ///< [m], by which it may be off in all
  std::size_t one_of = 1;  ///< stretch is drawn
};

/// How finely beads are drawn: to `within` [m] close to a point, else to what a pixel shows.
struct Detail {
  double pixel = 0;  ///< [m], what one shows where the beads are
  std::optional<Vec3> close_to_W;
  double closer_than = 12e-3, within = 6e-6;  ///< [m]
};

/// Beads that are swept alike. Their stretches are made anew each time: all at once they are larger than the
/// triangles.
struct Sweep {
  double by = HUGE_VAL;                       ///< [s]
  const std::vector<char>* chosen = nullptr;  ///< null: all
  double tolerance = 0;                       ///< [m], of the stretches and of their sides

  /// Whether `take` wanted all of them.
  bool each(const sim::BeadIndex& beads,
            const std::function<bool(const sim::BeadStretch&, int)>& take) const {
    return sim::sweep_beads(beads, {by, tolerance, HUGE_VAL, chosen}, [&](const sim::BeadStretch& stretch) {
      return take(stretch, sim::sides_within(stretch, 1.3 * tolerance));
    });
  }
};

/// Makes it coarser by a factor of three each time, until it is no more triangles than that. Its size.
sim::ShellSize coarsen(const sim::BeadIndex& beads, std::size_t triangles_most, Sweep& sweep) {
  constexpr double kCoarsest = 300e-6;
  for (;; sweep.tolerance *= 3) {
    sim::ShellSize size;
    const auto count = [&](const sim::BeadStretch& stretch, int sides) {
      const sim::ShellSize one = sim::sweep_size(stretch, sides);
      size.vertices += one.vertices;
      size.triangles += one.triangles;
      return sweep.tolerance >= kCoarsest || size.triangles <= triangles_most;
    };
    if (sweep.each(beads, count)) return size;
  }
}

Vec3 end_of(const sim::Bead& bead) {
  return Eigen::Map<const Eigen::Vector3f>(bead.to_W.data()).cast<double>();
}

/// What was laid by a time, in W.
std::optional<Printed> printed_surface(const sim::BeadIndex& beads, const Detail& detail,
                                       double by = HUGE_VAL) {
  std::vector<Sweep> sweeps;
  std::vector<char> close(beads.size(), 0), far(beads.size(), 1);
  if (detail.close_to_W) {
    for (std::size_t i = 0; i < beads.size(); ++i) {
      const bool is_close = (end_of(beads.bead(i)) - *detail.close_to_W).norm() < detail.closer_than;
      close[i] = is_close ? 1 : 0;
      far[i] = is_close ? 0 : 1;
    }
    sweeps.push_back({by, &close, detail.within / kOffMost});
  }
  sweeps.push_back({by, &far, detail.pixel / kOffMost});
  sim::ShellSize size;
  for (Sweep& sweep : sweeps) {
    const sim::ShellSize one = coarsen(beads, kTrianglesMost / 2, sweep);
    size.vertices += one.vertices;
    size.triangles += one.triangles;
  }
  const std::size_t stride = size.triangles / kTrianglesMost + 1;
  sim::SweptShell shells;
  shells.mesh.vertices.reserve(size.vertices / stride);
  shells.normals.reserve(size.vertices / stride);
  shells.mesh.triangles.reserve(size.triangles / stride);
  for (const Sweep& sweep : sweeps) {
    std::size_t stretches = 0;
    sweep.each(beads, [&](const sim::BeadStretch& stretch, int sides) {
      if (stretches++ % stride == 0) sim::append_whole(stretch, sides, shells);
      return true;
    });
  }
  if (shells.mesh.triangles.empty()) return std::nullopt;
  return Printed{bead_surface(std::move(shells)), kOffMost * sweeps.front().tolerance, stride};
}

constexpr std::size_t kPathPointsMost = 3000;

/// Where axes move the table, the machine stands level and the table is tilted.
void stand_level(const Pose& X_WO, renderer::PictureScene& drawn) {
  const Pose X_OW = X_WO.inverse(Eigen::Isometry);
  for (auto& shape : drawn.shapes) shape.shape.X_FS = X_OW * shape.shape.X_FS;
  for (auto& surface : drawn.surfaces) surface.X_WF = X_OW * surface.X_WF;
  for (auto& line : drawn.polylines)
    for (Vec3& point : line.points) point = X_OW * point;
}

/// Without what was laid.
renderer::PictureScene machine_and_path(const rehearsal::Scene& scene) {
  renderer::PictureScene drawn;
  for (const auto& shape : scene.bodies) drawn.shapes.push_back({shape, colour_of_body(shape.name)});
  drawn.shapes.push_back({scene.table, kTable});
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  // What is still to come, as a thin line; of a very long program its next stretches.
  std::size_t points = 0;
  for (const auto& line : scene.path) {
    if ((points += line.size()) > kPathPointsMost) break;
    drawn.polylines.push_back({line, kPath, 0.05e-3});
  }
  if (scene.X_WO) stand_level(*scene.X_WO, drawn);
  return drawn;
}

void add_printed(const rehearsal::Scene& scene, const Detail& detail, renderer::PictureScene& drawn) {
  if (!scene.printed) return;
  auto printed = printed_surface(scene.printed->beads(), detail, scene.time);
  if (!printed) return;
  if (scene.X_WO) printed->surface.X_WF = scene.X_WO->inverse(Eigen::Isometry);
  drawn.surfaces.push_back(std::move(printed->surface));
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

constexpr double kView = 30, kCloseView = 26;  // [deg], vertical

/// [m] that a pixel shows at that distance.
double pixel_at(double distance, double view_deg) {
  return 2 * std::tan(from_deg(view_deg) / 2) * distance / renderer::PictureScene{}.height;
}

/// Around the ends of what was laid.
Eigen::AlignedBox3d box_of(const sim::BeadIndex& beads) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < beads.size(); ++i) box.extend(end_of(beads.bead(i)));
  return box;
}

struct Captioned {
  renderer::Picture picture;
  std::string caption;
};

/// What was laid, without the machine.
std::optional<Captioned> draw_printed_part(const rehearsal::Scene& scene) {
  const sim::BeadIndex& beads = scene.printed->beads();
  const Eigen::AlignedBox3d box = box_of(beads);
  const double radius = std::max(3e-3, 0.5 * box.diagonal().norm()), distance = 4.6 * radius;
  auto printed = printed_surface(beads, {pixel_at(distance, kCloseView), {}});
  if (!printed) return std::nullopt;
  renderer::PictureScene drawn;
  drawn.surfaces.push_back(std::move(printed->surface));
  if (scene.part) drawn.shapes.push_back({{"part", geometry::MeshShape{scene.part}}, kPart});
  drawn.target_W = box.center();
  drawn.field_of_view = from_deg(kCloseView);
  drawn.eye_W = drawn.target_W + distance * Vec3(0.55, -0.70, 0.45).normalized();
  std::string caption =
      fmt::format("As printed: {} beads, drawn to within {:.0f} µm", beads.size(), to_um(printed->within));
  if (printed->one_of > 1) caption += fmt::format(", one stretch of {}", printed->one_of);
  return Captioned{renderer::render_picture(std::move(drawn)), caption};
}

renderer::Picture from_afar(const rehearsal::Scene& scene) {
  renderer::PictureScene drawn = machine_and_path(scene);
  const Ball around = enclose(drawn);
  const double distance = 3.5 * around.radius;
  add_printed(scene, {pixel_at(distance, kView), {}}, drawn);
  drawn.target_W = around.centre;
  drawn.eye_W = around.centre + distance * Vec3(0.62, -0.74, 0.24).normalized();
  drawn.field_of_view = from_deg(kView);
  return renderer::render_picture(std::move(drawn));
}

renderer::Picture close_up(const rehearsal::Scene& scene) {
  const Vec3 seen_from(0.055, -0.075, 0.028);
  const Vec3 tip_W = scene.X_WT.translation();
  renderer::PictureScene drawn = machine_and_path(scene);
  add_printed(scene, {pixel_at(seen_from.norm(), kCloseView), tip_W}, drawn);
  const Vec3 tip = scene.X_WO ? Vec3(scene.X_WO->inverse(Eigen::Isometry) * tip_W) : tip_W;
  drawn.target_W = tip + Vec3(0, 0, 2e-3);
  drawn.eye_W = drawn.target_W + seen_from;
  drawn.field_of_view = from_deg(kCloseView);
  return renderer::render_picture(std::move(drawn));
}

}  // namespace

Illustration illustration(const renderer::Picture& picture, std::string caption) {
  return {encode_png(picture), picture.width, picture.height, std::move(caption)};
}

renderer::Picture draw_overview(const rehearsal::Scene& scene) { return from_afar(scene); }

std::vector<Illustration> draw_scene(const rehearsal::Scene& scene) {
  // One is encoded while the next is drawn.
  std::vector<std::future<Illustration>> encoded;
  const auto add = [&](renderer::Picture picture, std::string caption) {
    encoded.push_back(std::async(std::launch::async, &illustration, std::move(picture), std::move(caption)));
    return_free_memory();
  };
  add(from_afar(scene), scene.simulated ? "Machine and part at the middle of the print"
                                        : "Machine at home; nothing was simulated");
  add(close_up(scene), "The tool on the path");
  if (scene.printed && scene.printed->beads().size() > 0)
    if (auto printed = draw_printed_part(scene))
      add(std::move(printed->picture), std::move(printed->caption));
  std::vector<Illustration> pictures;
  for (std::future<Illustration>& each : encoded) pictures.push_back(each.get());
  return pictures;
}

}  // namespace understudy::report

#include "report/picture/pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "sim/collision/collision.h"
#include "sim/surface/bead_mesh.h"

namespace understudy::rehearsal {
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

/// The middle of what is printed, or home when nothing was simulated.
const TracePoint* middle_of_print(const Record& record) {
  const auto extruding = [](const TracePoint& p) { return p.extruding; };
  const auto first = std::find_if(record.trace.begin(), record.trace.end(), extruding);
  if (first == record.trace.end()) return record.trace.empty() ? nullptr : &record.trace.back();
  const auto last = std::find_if(record.trace.rbegin(), record.trace.rend(), extruding).base();
  return &*(first + (last - first) / 2);
}

/// More points of path than this are drawn as what was printed instead.
constexpr std::size_t kPathPointsMost = 3000;

/// The programmed tip path; print moves apart from travel, so that the picture shows what is laid.
void add_path(const toolpath::Program& program, renderer::PictureScene& scene) {
  renderer::Polyline line{{}, kPath, 0.12e-3};
  Vec3 previous = Vec3::Zero();
  for (const auto& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    const Vec3 tip = step.X_WT.translation();
    if (step.kind == toolpath::StepKind::print) {
      if (line.points.empty()) line.points.push_back(previous);
      line.points.push_back(tip);
    } else if (!line.points.empty()) {
      scene.polylines.push_back(line);
      line.points.clear();
    }
    previous = tip;
  }
  if (!line.points.empty()) scene.polylines.push_back(line);
}

bool path_is_short(const toolpath::Program& program) {
  const auto prints = [](const toolpath::Step& s) { return s.kind == toolpath::StepKind::print; };
  return static_cast<std::size_t>(std::count_if(program.steps.begin(), program.steps.end(), prints)) <=
         kPathPointsMost;
}

std::array<float, 3> less(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// What was laid by a time, beads that go on in nearly the same direction as one: for pictures of large
/// prints.
std::vector<sim::Bead> joined(const sim::BeadIndex& beads, double by) {
  constexpr float kApart = 0.4e-3f, kLongest = 5e-3f, kStraight = 0.9f;  // [m], [m], cosine
  std::vector<sim::Bead> pieces;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const sim::Bead bead = beads.bead(i);
    if (static_cast<double>(bead.laid_at) > by) break;
    if (!pieces.empty()) {
      sim::Bead& last = pieces.back();
      const auto gap = less(bead.from_W, last.to_W), way = less(last.to_W, last.from_W),
                 next = less(bead.to_W, bead.from_W);
      const float lengths = std::sqrt(dot(way, way) * dot(next, next));
      if (dot(gap, gap) < kApart * kApart && dot(way, way) < kLongest * kLongest &&
          dot(way, next) >= kStraight * lengths) {
        last.to_W = bead.to_W;
        continue;
      }
    }
    pieces.push_back(bead);
  }
  return pieces;
}

/// What was laid by a time; of a very large print evenly chosen pieces.
std::optional<renderer::ColouredShape> printed_shape(const sim::BeadIndex& beads, double by = HUGE_VAL) {
  const std::vector<sim::Bead> pieces = joined(beads, by);
  const std::size_t stride = pieces.size() / kBeadsDrawn + 1;
  sim::BeadMesh shells;
  for (std::size_t i = 0; i < pieces.size(); i += stride)
    sim::append_shell(pieces[i], pieces.size() > kPathPointsMost ? 4 : 8, shells);
  if (shells.triangles.empty()) return std::nullopt;
  const auto mesh = std::make_shared<geometry::Mesh>(std::move(shells.vertices), std::move(shells.triangles));
  return renderer::ColouredShape{{"printed", geometry::MeshShape{mesh}}, kFilament, false};
}

renderer::PictureScene build_scene(const TwinSetup& setup, const sim::Workpiece* printed,
                                   const sim::Configuration& posture, double time) {
  renderer::PictureScene scene;
  const auto& machine = setup.machine;
  for (auto& shape : sim::machine_bodies(machine, setup.as_built, posture))
    scene.shapes.push_back({shape, colour_of(shape.name)});
  // The base has no part in collisions: a ring of joints tells where the struts hang.
  for (const Vec3& p_BB : setup.as_built.hexapod.base_joint) {
    if (machine.chain) break;
    geometry::Shape joint{"base joint", geometry::Sphere{1.6 * machine.hexapod.strut_radius}};
    joint.X_FS.translation() = machine.X_WB * p_BB;
    scene.shapes.push_back({joint, kMetal});
  }
  scene.shapes.push_back({machine.table, kTable});
  if (setup.part) scene.shapes.push_back({{"part", geometry::MeshShape{setup.part}}, kPart});
  if (path_is_short(setup.program)) {
    add_path(setup.program, scene);
  } else if (printed) {
    if (auto shape = printed_shape(printed->beads(), time)) scene.shapes.push_back(*shape);
  }
  return scene;
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

machine::AxisArray home_axes(const machine::MachineDescription& machine) {
  machine::AxisArray axes{};
  const auto mechanism = machine.make_mechanism();
  (void)mechanism->inverse(machine.X_BT_home, {}, axes);
  return axes;
}

/// What was laid, without the machine.
void add_printed_part(const TwinSetup& setup, const sim::Workpiece& printed, Record& record) {
  const sim::BeadIndex& beads = printed.beads();
  const auto shape = printed_shape(beads);
  if (!shape) return;
  const auto& mesh = *std::get<geometry::MeshShape>(shape->shape.form).mesh;
  renderer::PictureScene scene;
  scene.shapes.push_back(*shape);
  if (setup.part) scene.shapes.push_back({{"part", geometry::MeshShape{setup.part}}, kPart});
  scene.target_W = 0.5 * (mesh.lower() + mesh.upper());
  const double radius = std::max(3e-3, 0.5 * (mesh.upper() - mesh.lower()).norm());
  scene.field_of_view = from_deg(26);
  scene.eye_W = scene.target_W + 4.6 * radius * Vec3(0.55, -0.70, 0.45).normalized();
  record.pictures.push_back(renderer::render_picture(scene));
  record.picture_captions.push_back(fmt::format("As printed: {} beads", beads.size()));
}

}  // namespace

void add_pictures(const TwinSetup& setup, const sim::Workpiece* printed, Record& record) {
  const TracePoint* point = middle_of_print(record);
  const Pose X_WT = point ? point->X_WT : Pose(setup.machine.X_WB * setup.machine.X_BT_home);
  const sim::Configuration posture{X_WT, point ? point->axes : home_axes(setup.machine)};
  renderer::PictureScene scene = build_scene(setup, printed, posture, point ? point->time : 0);
  const Ball around = enclose(scene);
  scene.target_W = around.centre;
  scene.eye_W = around.centre + 3.5 * around.radius * Vec3(0.62, -0.74, 0.24).normalized();
  scene.field_of_view = from_deg(30);
  record.pictures.push_back(renderer::render_picture(scene));
  record.picture_captions.push_back(point ? "Machine and part at the middle of the print"
                                          : "Machine at home; nothing was simulated");

  scene.target_W = X_WT.translation() + Vec3(0, 0, 2e-3);
  scene.eye_W = scene.target_W + Vec3(0.055, -0.075, 0.028);
  scene.field_of_view = from_deg(26);
  record.pictures.push_back(renderer::render_picture(scene));
  record.picture_captions.push_back("The tool on the path");
  if (printed && printed->beads().size() > 0) add_printed_part(setup, *printed, record);
}

}  // namespace understudy::rehearsal

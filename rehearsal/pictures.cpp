#include "rehearsal/pictures.h"

#include <algorithm>

#include "core/units.h"
#include "sim/collision/collision.h"

namespace understudy::rehearsal {
namespace {

using Colour = std::array<float, 3>;
constexpr Colour kMetal{0.55f, 0.58f, 0.62f}, kStrut{0.25f, 0.42f, 0.62f}, kBrass{0.80f, 0.60f, 0.22f},
    kPart{0.86f, 0.88f, 0.84f}, kTable{0.90f, 0.90f, 0.91f}, kPath{0.85f, 0.25f, 0.10f},
    kHeater{0.45f, 0.20f, 0.18f};

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

renderer::PictureScene build_scene(const Stage& stage, const sim::Posture& posture) {
  renderer::PictureScene scene;
  const auto& machine = stage.machine;
  for (auto& shape : sim::machine_bodies(machine, stage.as_built, posture))
    scene.shapes.push_back({shape, colour_of(shape.name)});
  // The base has no part in collisions: a ring of joints tells where the struts hang.
  for (const Vec3& p_BB : stage.as_built.hexapod.base_joint) {
    if (machine.chain) break;
    geometry::Shape joint{"base joint", geometry::Sphere{1.6 * machine.hexapod.strut_radius}};
    joint.X_FS.translation() = machine.X_WB * p_BB;
    scene.shapes.push_back({joint, kMetal});
  }
  scene.shapes.push_back({machine.table, kTable});
  if (stage.part) scene.shapes.push_back({{"part", geometry::MeshShape{stage.part}}, kPart});
  add_path(stage.program, scene);
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

}  // namespace

void add_pictures(const Stage& stage, Record& record) {
  const TracePoint* point = middle_of_print(record);
  const Pose X_WT = point ? point->X_WT : Pose(stage.machine.X_WB * stage.machine.X_BT_home);
  const sim::Posture posture{X_WT, point ? point->axes : home_axes(stage.machine)};
  renderer::PictureScene scene = build_scene(stage, posture);
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
}

}  // namespace understudy::rehearsal

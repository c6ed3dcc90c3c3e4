#include "report/picture/render_images.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "rehearsal/scene.h"
#include "renderer/calibration_view.h"
#include "report/picture/png.h"
#include "report/picture/scene_pictures.h"
#include "sim/as_built/as_built.h"
#include "sim/sensors/microscope.h"
#include "studies/calibration/rig_scenes.h"

namespace understudy::report {
namespace {

using machine::MachineDescription;
using nlohmann::ordered_json;

ordered_json list(std::initializer_list<double> values) {
  ordered_json out = ordered_json::array();
  for (const double v : values) out.push_back(stable_number(v, "truth", 9));
  return out;
}

ordered_json pixel(const std::optional<Vec2>& px) {
  return px ? list({px->x(), px->y()}) : ordered_json(nullptr);
}

/// Position in mm, quaternion w first.
ordered_json pose_value(const Pose& X) {
  const Vec3 p = 1e3 * X.translation();
  Quat q(X.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  return {{"position_mm", list({p.x(), p.y(), p.z()})},
          {"quaternion_wxyz", list({q.w(), q.x(), q.y(), q.z()})}};
}

ordered_json camera_value(const Camera& camera) {
  return {{"width_px", camera.width},
          {"height_px", camera.height},
          {"focal_px", camera.focal_px},
          {"centre_px", list({camera.centre_px.x(), camera.centre_px.y()})},
          {"distortion", list({camera.k1, camera.k2, camera.p1, camera.p2})}};
}

std::string laser(const RenderRequest& request, const MachineDescription& machine, const Pose& X_WT,
                  ordered_json& truth) {
  if (!machine.has_microscope) throw InputError(fmt::format("{} has no laser and microscope", machine.name));
  sim::Microscope microscope(machine, nullptr, request.seed);
  const Camera& camera = machine.microscope.camera;
  truth["camera"] = camera_value(camera);
  truth["dot_px"] = pixel(microscope.true_dot(X_WT));
  // The surface is the table: the gap is the tip's distance from it along the tool's axis.
  const double along = tool_axis(X_WT).z();
  if (along > 0) truth["gap_mm"] = list({to_mm(X_WT.translation().z() / along)})[0];
  return encode_png(microscope.expose(X_WT, camera.sensor(), 1));
}

vision::CalibrationRig rig_of(const RenderRequest& request, const MachineDescription& machine) {
  if (request.camera < 0 || request.camera > 1)
    throw InputError(fmt::format("--camera {} is not 0 or 1", request.camera));
  return vision::default_calibration_rig((machine.X_WB * machine.X_BT_home).translation());
}

std::string chessboard(const RenderRequest& request, const MachineDescription& machine, ordered_json& truth) {
  const vision::CalibrationRig rig = rig_of(request, machine);
  if (request.layer < 0 || request.layer >= rig.layers)
    throw InputError(fmt::format("--layer {} is outside 0 to {}", request.layer, rig.layers - 1));
  renderer::BoardScene scene =
      studies::board_scene(rig, studies::built_as_designed(rig), request.camera, request.layer);
  scene.exposure.seed = request.seed;
  truth["camera"] = camera_value(scene.camera);
  truth["X_CG"] = pose_value(scene.X_CG);
  truth["board"] = {
      {"columns", rig.board.columns}, {"rows", rig.board.rows}, {"square_mm", to_mm(rig.board.square)}};
  truth["corners_px"] = ordered_json::array();
  for (const auto& corner : renderer::true_corners(scene)) truth["corners_px"].push_back(pixel(corner));
  renderer::CalibrationView view;
  return encode_png(view.render(scene, scene.camera.sensor()));
}

std::string targets(const RenderRequest& request, const MachineDescription& machine, const Pose& X_WT,
                    ordered_json& truth) {
  const vision::CalibrationRig rig = rig_of(request, machine);
  renderer::TargetScene scene =
      studies::target_scene(rig, studies::built_as_designed(rig), request.camera, X_WT);
  scene.exposure.seed = request.seed;
  truth["camera"] = camera_value(scene.camera);
  truth["X_WC"] = pose_value(rig.cameras[static_cast<std::size_t>(request.camera)].X_WC);
  truth["radius_mm"] = to_mm(scene.radius);
  truth["targets"] = ordered_json::array();
  for (const Vec3& centre : scene.centres_C)
    truth["targets"].push_back(
        {{"centre_C_mm", list({to_mm(centre.x()), to_mm(centre.y()), to_mm(centre.z())})},
         {"centre_px", pixel(renderer::true_sphere_centre(scene.camera, centre))},
         {"outline_centre_px", pixel(renderer::true_outline_centre(scene.camera, centre, scene.radius))}});
  renderer::CalibrationView view;
  return encode_png(view.render(scene, scene.camera.sensor()));
}

/// The overview of a rehearsal that stands still at the pose.
std::string scene(const MachineDescription& machine, const Pose& X_WT, ordered_json& truth) {
  const auto mechanism = machine.make_mechanism();
  sim::Configuration configuration{X_WT, {}};
  const auto axes = std::span(configuration.axes).first(static_cast<std::size_t>(mechanism->axis_count()));
  if (const auto solved = mechanism->inverse(machine.X_WB.inverse() * X_WT, {}, axes);
      solved != kinematics::SolveStatus::ok)
    throw InputError(fmt::format("{} cannot take this pose: {}", machine.name, to_string(solved)));
  std::vector<kinematics::LimitViolation> violations;
  mechanism->check(machine.X_WB.inverse() * X_WT, axes, violations);
  if (!violations.empty())
    throw InputError(
        fmt::format("{} cannot take this pose: {}", machine.name, to_string(violations.front())));
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    const bool angle = mechanism->axis_is_angle(i);
    const double value = axes[i];
    truth["axes"][mechanism->axis_name(i) + (angle ? "_deg" : "_mm")] =
        list({angle ? to_deg(value) : to_mm(value)})[0];
  }
  return encode_png(
      draw_overview(rehearsal::machine_scene(machine, sim::as_described(machine), configuration)));
}

Pose default_pose(const RenderRequest& request, const MachineDescription& machine) {
  Pose X_WT = machine.X_WB * machine.X_BT_home;
  if (request.kind == "laser") X_WT.translation().z() = machine.gap.aim;
  return X_WT;
}

}  // namespace

RenderedImage render_image(const RenderRequest& request) {
  const MachineDescription machine = machine::load_machine(request.machine);
  const Pose X_WT = request.X_WT.value_or(default_pose(request, machine));
  RenderedImage image;
  ordered_json truth{{"schema", "understudy.image/1"}, {"kind", request.kind}, {"machine", machine.name}};
  if (request.kind != "chessboard") truth["X_WT"] = pose_value(X_WT);
  if (request.kind == "laser")
    image.png = laser(request, machine, X_WT, truth);
  else if (request.kind == "chessboard")
    image.png = chessboard(request, machine, truth);
  else if (request.kind == "targets")
    image.png = targets(request, machine, X_WT, truth);
  else if (request.kind == "scene")
    image.png = scene(machine, X_WT, truth);
  else
    throw InputError(
        fmt::format("nothing renders '{}': one of laser, chessboard, targets, scene", request.kind));
  truth["provenance"] = {{"version", kVersion},
                         {"machine_sha256", machine.sha256},
                         {"seed", request.seed},
                         {"command", request.command}};
  image.truth = truth.dump(1) + "\n";
  return image;
}

}  // namespace understudy::report

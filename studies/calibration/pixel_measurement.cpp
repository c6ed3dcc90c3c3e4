#include "studies/calibration/pixel_measurement.h"

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "calibration/pose_choice.h"
#include "core/cut_image.h"
#include "core/error.h"
#include "core/parallel.h"
#include "vision/boards/chessboard.h"
#include "vision/boards/rig_measurement.h"
#include "vision/picture/picture_file.h"

namespace understudy::studies {
namespace {

constexpr double kDepth = 50e-3;         // [m] from the first layer to the last
constexpr double kCornerSigma = 0.04;    // [px], of a measured corner in u or v
constexpr double kPrincipalSigma = 0.1;  // [px]: the lens's axis was found before, on a bench

/// Measured corners of one board; throws MachineError where there are none.
vision::SeenBoard photograph_board(renderer::CalibrationView& view, const vision::RigDescription& believed,
                                   const BuiltRig& built, const StandOptions& options, int camera,
                                   int layer) {
  renderer::BoardScene scene = board_scene(believed.rig, built, camera, layer);
  scene.exposure.seed = options.seed;
  scene.exposure.frame = static_cast<std::uint64_t>(100 * camera + layer);
  const Image picture = view.render(scene, scene.camera.sensor());
  if (options.keep) options.keep(believed.board_pictures.name({camera, layer}), picture);
  const auto seen = vision::measure_board(picture, believed.rig.board);
  if (seen.status != vision::BoardStatus::ok)
    throw MachineError(
        fmt::format("camera {}, board in layer {}: {}", camera, layer, vision::to_string(seen.status)));
  return {camera, layer, seen.corners_px};
}

std::vector<vision::SeenBoard> photograph_boards(const vision::RigDescription& believed,
                                                 const BuiltRig& built, const StandOptions& options,
                                                 int threads, const std::function<void(double)>& progress) {
  const int layers = believed.rig.layers, count = 2 * layers;
  std::vector<vision::SeenBoard> boards(static_cast<std::size_t>(count));
  const auto photographer = [&] {
    const auto view = std::make_shared<renderer::CalibrationView>();
    return IndexedWork([&, view](std::size_t n) {
      const auto number = static_cast<int>(n);
      boards[n] = photograph_board(*view, believed, built, options, number / layers, number % layers);
    });
  };
  in_parallel_with(boards.size(), threads, photographer, [&](std::size_t, std::size_t done) {
    if (progress) progress(static_cast<double>(done) / count);
  });
  return boards;
}

}  // namespace

vision::RigDescription designed_stand(const machine::MachineDescription& machine,
                                      const StandOptions& options) {
  if (machine.is_chain())
    throw InputError(fmt::format("{}: the two cameras are made for a hexapod's platform", machine.name));
  if (options.layers < 2)
    throw InputError(fmt::format("measuring stand: {} layers of boards, 2 are needed", options.layers));
  vision::RigDescription believed;
  believed.rig = vision::default_calibration_rig((machine.X_WB * machine.X_BT_home).translation());
  believed.rig.layers = options.layers;
  believed.rig.layer_spacing = kDepth / (options.layers - 1);
  believed.uncertainty = {.boards = options.boards,
                          .corner_px = kCornerSigma,
                          .principal_px = kPrincipalSigma,
                          .seed = options.seed};
  believed.board_pictures = vision::board_picture_name();
  believed.pose_pictures = vision::pose_picture_name();
  return believed;
}

MeasuringStand::MeasuringStand(const machine::MachineDescription& machine, const StandOptions& options,
                               int threads, const std::function<void(double)>& progress)
    : options_(options),
      X_WB_(machine.X_WB),
      X_BT_home_(machine.X_BT_home),
      description_(designed_stand(machine, options)),
      built_(sample_built_rig(description_.rig, options.boards, kPrincipalSigma, options.seed)) {
  boards_ = photograph_boards(description_, built_, options, threads, progress);
  vision::CalibrationUncertainty uncertainty = description_.uncertainty;
  // This calibration has one scale a board and no bow.
  uncertainty.boards.scale = std::hypot(options.boards.scale, options.boards.print_scale);
  model_ = vision::calibrate_rig(description_.rig, boards_, options.method, uncertainty);
}

std::vector<Pose> MeasuringStand::poses_in_view(const kinematics::Mechanism& mechanism, std::size_t count,
                                                Random& random) const {
  calibration::PoseRegion region = calibration::reference_region(X_BT_home_);
  region.half_size = Vec3(40e-3, 40e-3, 40e-3);
  std::vector<Pose> poses;
  for (std::size_t tries = 0; poses.size() < count; ++tries) {
    if (tries > 200 * count)
      throw InputError(
          fmt::format("cameras: {} of {} reachable poses show all targets", poses.size(), tries));
    const Pose X_BT = calibration::random_reachable_poses(mechanism, region, 1, random)[0];
    if (vision::targets_in_view(designed(), X_WB_ * X_BT)) poses.push_back(X_BT);
  }
  return poses;
}

std::array<vision::TargetsMeasurement, 2> MeasuringStand::see(renderer::CalibrationView& view,
                                                              const Pose& X_WT_true,
                                                              const Pose& X_WT_expected,
                                                              std::uint64_t number) const {
  std::array<vision::TargetsMeasurement, 2> seen;
  for (int camera = 0; camera < 2; ++camera) {
    const auto k = static_cast<std::size_t>(camera);
    renderer::TargetScene scene = target_scene(designed(), built_, camera, X_WT_true);
    scene.exposure.seed = options_.seed;
    scene.exposure.frame = 2 * number + k + 1000;
    vision::ReadOut read_out = [&](const Region& region) { return view.render(scene, region); };
    if (options_.keep) {
      const Image picture = view.render(scene, scene.camera.sensor());
      options_.keep(description_.pose_pictures.name({static_cast<int>(number), camera}), picture);
      read_out = [picture](const Region& region) { return cut(picture, region); };
    }
    seen[k] = vision::find_targets(designed(), camera, X_WT_expected, read_out);
  }
  return seen;
}

calibration::CameraPose MeasuringStand::pose_of(const std::array<vision::TargetsMeasurement, 2>& seen) const {
  return calibration::camera_pose(vision::measure_pose(model_, designed().targets, seen));
}

calibration::CameraPose MeasuringStand::measure(renderer::CalibrationView& view, const Pose& X_WT_true,
                                                const Pose& X_WT_expected, std::uint64_t number) const {
  return pose_of(see(view, X_WT_true, X_WT_expected, number));
}

}  // namespace understudy::studies

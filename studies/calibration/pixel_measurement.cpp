#include "studies/calibration/pixel_measurement.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "calibration/pose_choice.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "vision/boards/chessboard.h"

namespace understudy::studies {
namespace {

constexpr double kDepth = 50e-3;         // [m] from the first layer to the last
constexpr double kCornerSigma = 0.04;    // [px], of a measured corner in u or v
constexpr double kPrincipalSigma = 0.1;  // [px]: the lens's axis was found before, on a bench
constexpr double kMiss = 90;             // [px] by which a machine before calibration usually misses: 8 mm
constexpr double kSearch = 180;          // [px], second look; targets are 400 px apart or more
constexpr double kOutlineMargin = 14;    // [px] that a target's edge search needs around it

Vec3 normal_vector(Random& random, double sigma) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sigma * Vec3(x, y, z);
}

CalibrationRig mounted(const CalibrationRig& designed, std::uint64_t seed) {
  CalibrationRig built = designed;
  for (std::size_t i = 0; i < 2; ++i) {
    Random random(seed, fmt::format("measuring stand/camera {}", i + 1));
    Camera& camera = built.cameras[i].camera;
    camera.focal_px *= 1 + 3e-3 * random.normal();
    camera.centre_px += kPrincipalSigma * Vec2(random.normal(), random.normal());
    camera.k1 = random.uniform(-0.12, 0.12);
    camera.k2 = random.uniform(-0.15, 0.15);
    camera.p1 = random.uniform(-5e-4, 5e-4);
    camera.p2 = random.uniform(-5e-4, 5e-4);
    const Vec3 turn = normal_vector(random, 2e-3), shift = normal_vector(random, 0.3e-3);
    built.cameras[i].X_WC = built.cameras[i].X_WC * make_pose(exp_rotation(turn), shift);
  }
  return built;
}

/// Measured corners of one board; throws MachineError where there are none.
vision::BoardLayer photograph_board(renderer::CalibrationView& view, const CalibrationRig& designed,
                                    const CalibrationRig& built, const StandOptions& options, int camera,
                                    int layer) {
  Random random(options.seed, fmt::format("measuring stand/board {}/{}", camera + 1, layer + 1));
  renderer::BoardScene scene =
      renderer::board_scene(built, camera, layer, sample_placement(options.boards, random));
  // The board stands where the designed rig says, not where the mounted camera looks.
  const auto k = static_cast<std::size_t>(camera);
  const Pose X_WG = designed.X_WG(camera, layer);
  scene.X_CG = built.cameras[k].X_WC.inverse() * X_WG;
  scene.exposure.seed = options.seed;
  scene.exposure.frame = static_cast<std::uint64_t>(100 * camera + layer);
  const auto seen =
      vision::measure_board(view.render(scene, {0, 0, scene.camera.width, scene.camera.height}), built.board);
  if (seen.status != vision::BoardStatus::ok)
    throw MachineError(fmt::format("camera {}, board in layer {}: {}", camera + 1, layer + 1,
                                   vision::to_string(seen.status)));
  return {X_WG, seen.corners_px};
}

std::array<vision::CameraLayers, 2> photograph_boards(const CalibrationRig& designed,
                                                      const CalibrationRig& built,
                                                      const StandOptions& options, int threads,
                                                      const std::function<void(double)>& progress) {
  const int count = 2 * built.layers;
  std::vector<vision::BoardLayer> boards(static_cast<std::size_t>(count));
  const auto photographer = [&] {
    const auto view = std::make_shared<renderer::CalibrationView>();
    return IndexedWork([&, view](std::size_t n) {
      const auto number = static_cast<int>(n);
      boards[n] =
          photograph_board(*view, designed, built, options, number / built.layers, number % built.layers);
    });
  };
  in_parallel_with(boards.size(), threads, photographer, [&](std::size_t, std::size_t done) {
    if (progress) progress(static_cast<double>(done) / count);
  });
  std::array<vision::CameraLayers, 2> layers;
  for (int n = 0; n < count; ++n) {
    const auto camera = static_cast<std::size_t>(n / built.layers);
    layers[camera].camera = designed.cameras[camera];
    layers[camera].board = built.board;
    layers[camera].layers.push_back(boards[static_cast<std::size_t>(n)]);
  }
  return layers;
}

Region around(const std::array<Vec2, 3>& centres, double margin) {
  Vec2 low = centres[0], high = centres[0];
  for (const Vec2& c : centres) low = low.cwiseMin(c), high = high.cwiseMax(c);
  const int x = static_cast<int>(std::floor(low.x() - margin)),
            y = static_cast<int>(std::floor(low.y() - margin));
  return {x, y, static_cast<int>(std::ceil(high.x() + margin)) - x,
          static_cast<int>(std::ceil(high.y() + margin)) - y};
}

Region on_sensor(const Region& wanted, const Camera& camera) {
  const int x = std::clamp(wanted.x, 0, camera.width - 1), y = std::clamp(wanted.y, 0, camera.height - 1);
  return {x, y, std::clamp(wanted.x + wanted.width, x + 1, camera.width) - x,
          std::clamp(wanted.y + wanted.height, y + 1, camera.height) - y};
}

double radius_px(const CalibrationRig& rig) {
  return rig.target_radius * rig.cameras[0].camera.focal_px / rig.middle_distance;
}

}  // namespace

calibration::MeasuringFrame take_out_frame(std::vector<PixelPose>& poses) {
  std::vector<calibration::SharedError> shared;
  for (const PixelPose& pose : poses)
    if (pose.ok()) shared.push_back({pose.X_BT.translation(), pose.shared, Mat6::Zero()});
  const calibration::MeasuringFrame frame = calibration::measuring_frame(shared);
  std::size_t next = 0;
  for (PixelPose& pose : poses)
    if (pose.ok()) pose.covariance = pose.detection + shared[next++].left;
  return frame;
}

MeasuringStand::MeasuringStand(const machine::MachineDescription& machine, const StandOptions& options,
                               int threads, const std::function<void(double)>& progress)
    : options_(options), X_WB_(machine.X_WB), X_BT_home_(machine.X_BT_home) {
  if (machine.is_chain())
    throw InputError(fmt::format("{}: the two cameras are made for a hexapod's platform", machine.name));
  if (options.layers < 2)
    throw InputError(fmt::format("measuring stand: {} layers of boards, 2 are needed", options.layers));
  designed_ = default_calibration_rig((X_WB_ * X_BT_home_).translation());
  designed_.layers = options.layers;
  designed_.layer_spacing = kDepth / (options.layers - 1);
  built_ = mounted(designed_, options.seed);
  model_ = vision::calibrate_stereo(options.method,
                                    photograph_boards(designed_, built_, options, threads, progress),
                                    {.boards = options.boards,
                                     .corner_px = kCornerSigma,
                                     .principal_px = kPrincipalSigma,
                                     .seed = options.seed});
}

std::array<Vec2, 3> MeasuringStand::targets_px(int camera, const Pose& X_WT) const {
  const MountedCamera& mount = designed_.cameras[static_cast<std::size_t>(camera)];
  std::array<Vec2, 3> pixels;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto seen = mount.camera.project(mount.X_WC.inverse() * X_WT * designed_.targets[k]);
    pixels[k] = seen.value_or(Vec2(-1e4, -1e4));
  }
  return pixels;
}

bool MeasuringStand::in_view(const Pose& X_BT) const {
  // A target 50 mm nearer than the middle is an eighth larger.
  const double margin = 1.15 * radius_px(designed_) + kOutlineMargin + kMiss;
  for (int camera = 0; camera < 2; ++camera) {
    const Camera& lens = designed_.cameras[static_cast<std::size_t>(camera)].camera;
    for (const Vec2& p : targets_px(camera, X_WB_ * X_BT))
      if (p.x() < margin || p.y() < margin || p.x() > lens.width - 1 - margin ||
          p.y() > lens.height - 1 - margin)
        return false;
  }
  return true;
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
    if (in_view(X_BT)) poses.push_back(X_BT);
  }
  return poses;
}

PixelPose MeasuringStand::measure(renderer::CalibrationView& view, const Pose& X_BT_true,
                                  const Pose& X_BT_expected, std::uint64_t frame) const {
  std::array<vision::TargetsMeasurement, 2> seen;
  for (int camera = 0; camera < 2; ++camera) {
    const auto k = static_cast<std::size_t>(camera);
    renderer::TargetScene scene = renderer::target_scene(built_, camera, X_WB_ * X_BT_true);
    scene.exposure.seed = options_.seed;
    scene.exposure.frame = 2 * frame + k + 1000;
    const std::array<Vec2, 3> expected = targets_px(camera, X_WB_ * X_BT_expected);
    vision::TargetOptions options;
    options.camera = designed_.cameras[k].camera;
    options.radius_px = radius_px(designed_);
    const double rim = 1.15 * options.radius_px + kOutlineMargin;
    for (const double miss : {kMiss, kSearch}) {
      options.search_px = miss;
      const Region region = on_sensor(around(expected, rim + miss), options.camera);
      seen[k] = vision::measure_targets(view.render(scene, region), expected, options);
      if (seen[k].status == vision::TargetStatus::ok) break;
    }
  }
  const auto found = vision::measure_pose(model_, designed_.targets, seen);
  PixelPose pose;
  if (found.status != vision::PoseStatus::ok) {
    pose.failure = vision::to_string(found.status);
    if (found.status == vision::PoseStatus::target_not_measured)
      pose.failure = fmt::format("camera {}, target {}: {}", found.camera + 1, found.target + 1,
                                 vision::to_string(found.target_status));
    return pose;
  }
  const Mat3 R_BW = X_WB_.linear().transpose();
  Mat6 turn = Mat6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = R_BW;
  pose.X_BT = X_WB_.inverse() * found.X_WT;
  pose.covariance = turn * found.total() * turn.transpose();
  pose.detection = turn * found.covariance * turn.transpose();
  for (const Twist& shift : found.replicas) pose.shared.push_back(turn * shift);
  pose.beyond = found.beyond;
  return pose;
}

}  // namespace understudy::studies

#include "vision/boards/rig_measurement.h"

#include <algorithm>
#include <cmath>

namespace understudy::vision {
namespace {

constexpr double kMiss = 8.437e-3;     // [m] by which a machine before calibration usually misses
constexpr double kSearch = 2 * kMiss;  // [m], second look
constexpr double kOutlineMargin = 14;  // [px] that a target's edge search needs around it
constexpr double kFarOutside = 1e5;    // [px]: any sensor's size fits in, and an int
// A target 50 mm nearer than the middle of 400 mm is an eighth larger.
constexpr double kNearer = 1.15;
constexpr double kOwnHalf = 0.49;  // of the distance to the nearest other target

double px_per_metre(const CalibrationRig& rig, int camera) {
  return rig.cameras[static_cast<std::size_t>(camera)].camera.focal_px / rig.middle_distance;
}

Region around(const std::array<Vec2, 3>& centres, double margin) {
  const Vec2 low = centres[0].cwiseMin(centres[1]).cwiseMin(centres[2]);
  const Vec2 high = centres[0].cwiseMax(centres[1]).cwiseMax(centres[2]);
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

double least_distance(const std::array<Vec2, 3>& p) {
  return std::min({(p[0] - p[1]).norm(), (p[1] - p[2]).norm(), (p[2] - p[0]).norm()});
}

}  // namespace

CameraLayers camera_layers(const CalibrationRig& rig, const std::vector<SeenBoard>& boards, int camera) {
  CameraLayers layers{rig.cameras[static_cast<std::size_t>(camera)], rig.board, {}};
  std::vector<SeenBoard> own;
  for (const SeenBoard& board : boards)
    if (board.camera == camera) own.push_back(board);
  std::stable_sort(own.begin(), own.end(),
                   [](const SeenBoard& a, const SeenBoard& b) { return a.layer < b.layer; });
  for (const SeenBoard& board : own)
    layers.layers.push_back({rig.X_WG(board.camera, board.layer), board.corners_px});
  return layers;
}

StereoModel calibrate_rig(const CalibrationRig& rig, const std::vector<SeenBoard>& boards,
                          ViewRayMethod method, const CalibrationUncertainty& uncertainty) {
  return calibrate_stereo(method, {camera_layers(rig, boards, 0), camera_layers(rig, boards, 1)},
                          uncertainty);
}

double target_radius_px(const CalibrationRig& rig, int camera) {
  return rig.target_radius * px_per_metre(rig, camera);
}

std::array<Vec2, 3> expected_targets(const CalibrationRig& rig, int camera, const Pose& X_WT) {
  const MountedCamera& mounted = rig.cameras[static_cast<std::size_t>(camera)];
  std::array<Vec2, 3> pixels;
  for (std::size_t k = 0; k < 3; ++k)
    pixels[k] = mounted.camera.project(mounted.X_WC.inverse() * X_WT * rig.targets[k])
                    .value_or(Vec2::Constant(-kFarOutside))
                    .cwiseMax(-kFarOutside)
                    .cwiseMin(kFarOutside);
  return pixels;
}

bool targets_in_view(const CalibrationRig& rig, const Pose& X_WT) {
  for (int camera = 0; camera < 2; ++camera) {
    const Camera& lens = rig.cameras[static_cast<std::size_t>(camera)].camera;
    const double margin =
        kNearer * target_radius_px(rig, camera) + kOutlineMargin + kMiss * px_per_metre(rig, camera);
    for (const Vec2& p : expected_targets(rig, camera, X_WT))
      if (p.x() < margin || p.y() < margin || p.x() > lens.width - 1 - margin ||
          p.y() > lens.height - 1 - margin)
        return false;
  }
  return true;
}

TargetsMeasurement find_targets(const CalibrationRig& rig, int camera, const Pose& X_WT_expected,
                                const ReadOut& read_out) {
  TargetOptions options;
  options.camera = rig.cameras[static_cast<std::size_t>(camera)].camera;
  options.radius_px = target_radius_px(rig, camera);
  const std::array<Vec2, 3> expected = expected_targets(rig, camera, X_WT_expected);
  const double rim = kNearer * options.radius_px + kOutlineMargin;
  TargetsMeasurement seen;
  for (const double miss : {kMiss, kSearch}) {
    options.search_px =
        std::max(1.0, std::min(miss * px_per_metre(rig, camera), kOwnHalf * least_distance(expected)));
    const Region region = on_sensor(around(expected, rim + options.search_px), options.camera);
    seen = measure_targets(read_out(region), expected, options);
    if (seen.status == TargetStatus::ok) break;
  }
  return seen;
}

}  // namespace understudy::vision

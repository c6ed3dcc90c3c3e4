// Two cameras whose corners and targets are projected, not drawn: the truth comes from Camera::project alone.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/random_vector.h"
#include "vision/boards/calibration_rig.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::vision {

inline CalibrationRig reference_rig() { return default_calibration_rig(Vec3(0, 0, 0.1)); }

/// Corners of every layer as seen in the true cameras, boards misplaced by `tolerance`, pixels by
/// `corner_px`.
inline std::array<CameraLayers, 2> observed_layers(const CalibrationRig& nominal,
                                                   const std::array<MountedCamera, 2>& truth,
                                                   const BoardTolerance& tolerance, double corner_px,
                                                   Random& random) {
  std::array<CameraLayers, 2> all;
  for (std::size_t i = 0; i < 2; ++i) {
    all[i].camera = nominal.cameras[i];
    all[i].board = nominal.board;
    for (int layer = 0; layer < nominal.layers; ++layer) {
      const BoardPlacement placement = sample_placement(tolerance, random);
      BoardLayer seen{nominal.X_WG(static_cast<int>(i), layer), {}};
      for (int k = 0; k < nominal.board.corners(); ++k) {
        const Vec3 p_G = nominal.board.corner(k % nominal.board.columns, k / nominal.board.columns);
        const Vec3 p_C = truth[i].X_WC.inverse() * seen.X_WG * placement.moved(p_G);
        seen.corners_px.push_back(truth[i].camera.project(p_C).value() + corner_px * normal_vec2(random));
      }
      all[i].layers.push_back(seen);
    }
  }
  return all;
}

/// A point's pixels in both true cameras, with noise and its covariance.
inline std::array<PixelPoint, 2> observed_point(const std::array<MountedCamera, 2>& truth, const Vec3& p_W,
                                                double sigma_px, Random& random) {
  std::array<PixelPoint, 2> seen;
  for (std::size_t i = 0; i < 2; ++i) {
    seen[i].pixel =
        truth[i].camera.project(truth[i].X_WC.inverse() * p_W).value() + sigma_px * normal_vec2(random);
    seen[i].covariance = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  }
  return seen;
}

/// The cameras are not quite what they were designed to be.
inline std::array<MountedCamera, 2> true_cameras(const CalibrationRig& nominal) {
  std::array<MountedCamera, 2> truth = nominal.cameras;
  truth[0].camera.k1 = -0.12, truth[0].camera.k2 = 0.15, truth[0].camera.p1 = 4e-4,
  truth[0].camera.p2 = -3e-4;
  truth[1].camera.k1 = 0.08, truth[1].camera.p1 = -2e-4, truth[1].camera.p2 = 5e-4;
  truth[0].camera.focal_px *= 1.004, truth[1].camera.focal_px *= 0.997;
  truth[0].camera.centre_px += Vec2(6, -4), truth[1].camera.centre_px += Vec2(-5, 7);
  for (std::size_t i = 0; i < 2; ++i) {
    truth[i].X_WC =
        truth[i].X_WC * make_pose(exp_rotation(Vec3(2e-3, -1e-3, 3e-3)), Vec3(0.4e-3, -0.3e-3, 0.5e-3));
  }
  return truth;
}

inline Vec3 middle_of_volume(const CalibrationRig& rig) {
  return rig.cameras[0].X_WC * Vec3(0, 0, rig.middle_distance);
}

struct Square {
  double sum = 0;
  int count = 0;
  void add(double squared) { sum += squared, ++count; }
  double rms() const { return std::sqrt(sum / count); }
};

}  // namespace understudy::vision

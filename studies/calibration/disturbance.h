// Private to the benchmark's trials: the disturbances that hexapods and chains share.
#pragma once

#include "calibration/synthetic.h"

namespace understudy::studies {

constexpr calibration::MeasurementNoise kOutlier{1e-3, 10e-3};
constexpr calibration::MeasurementNoise kFrameNoise{50e-6, 0.5e-3};
constexpr double kFrameScale = 0.5e-3;
constexpr double kDeviationError = 1e-3;  // [m]
constexpr double kWarming = 20;           // [K], over the measurement

/// An eighth of the poses, at least one.
inline std::size_t outlier_count(std::size_t poses) { return poses < 12 ? 1 : (poses + 4) / 8; }

/// The measuring frame's error: the same in every pose, about the middle of the work space.
struct FrameError {
  Vec3 shift = Vec3::Zero(), turn = Vec3::Zero(), centre = Vec3::Zero();
  double scale = 0;

  FrameError(const Vec3& about, Random& random) : centre(about) {
    for (Eigen::Index k = 0; k < 3; ++k) shift[k] = kFrameNoise.position * random.normal();
    for (Eigen::Index k = 0; k < 3; ++k) turn[k] = kFrameNoise.rotation * random.normal();
    scale = kFrameScale * random.normal();
  }
  Pose seen(const Pose& X) const {
    const Mat3 R = exp_rotation(turn);
    return make_pose(Mat3(R * X.linear()),
                     Vec3(centre + shift + (1 + scale) * (R * (X.translation() - centre))));
  }
};

}  // namespace understudy::studies

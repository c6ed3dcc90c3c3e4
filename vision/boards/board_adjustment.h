// Private to this room: camera and boards adjusted together.
#pragma once

#include "vision/boards/view_ray.h"

namespace understudy::vision {

constexpr int kCameraParameters = 13;
/// Rotation vector and translation of X_CF [rad, m], focal length, centre [px], k1, k2, p1, p2.
using CameraParameters = Eigen::Matrix<double, kCameraParameters, 1>;
using CameraCovariance = Eigen::Matrix<double, kCameraParameters, kCameraParameters>;

struct BoardAdjustment {
  CameraParameters camera = CameraParameters::Zero();
  CameraCovariance covariance = CameraCovariance::Zero();
  double residual_px = 0;  ///< RMS of u and v about the adjusted boards
};

/// Maximum likelihood over the camera and over each board's placement (seven numbers), which the uncertainty
/// binds to where the board is meant to be; F is the frame of the designed camera. What the slope of the
/// boards' offsets over depth does to the view rays (2 mrad for 0.1 mm) cannot be distinguished from an
/// offset of the principal point. Where that is known, the camera's direction comes from the mean tilt of all
/// boards, seen in their perspective (0.3 mrad for 1 mrad each), and the view rays' errors fall to that of
/// the mean offset. `start` must be near (cv::calibrateCamera with all boards where they are meant to be).
BoardAdjustment adjust_boards(const CameraLayers& layers, const CalibrationUncertainty& uncertainty,
                              const CameraParameters& start);

}  // namespace understudy::vision

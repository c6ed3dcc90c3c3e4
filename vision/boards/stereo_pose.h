// The pose of the moving platform from the three targets in two pictures (Song 2015, section 4, appendix
// B.2).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "vision/boards/targets.h"
#include "vision/boards/view_ray.h"

namespace understudy::vision {

struct StereoModel {
  std::array<std::shared_ptr<const ViewRayModel>, 2> cameras;
};

/// Calibrates both cameras; the seeds of their replicas differ. Throws as calibrate_view_rays, naming the
/// camera.
StereoModel calibrate_stereo(ViewRayMethod method, const std::array<CameraLayers, 2>& layers,
                             const CalibrationUncertainty& uncertainty);

struct PixelPoint {
  Vec2 pixel{0, 0};
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< [px^2]
};

struct LocatedPoint {
  Approach place;
  Mat3 covariance = Mat3::Zero();  ///< [m^2], from the pixels alone
};

/// One point from its pixels in both cameras.
LocatedPoint locate(const StereoModel& model, const std::array<PixelPoint, 2>& seen);

enum class PoseStatus {
  ok,
  target_not_measured,    ///< see camera, target and target_status
  view_rays_do_not_meet,  ///< the view rays of a target pass each other
  wrong_shape,            ///< the targets do not form the triangle they are said to
  targets_in_line,
};
const char* to_string(PoseStatus s);

struct PoseOptions {
  double gap_max = 1e-3;    ///< [m] between the two view rays of a target
  double shape_max = 1e-3;  ///< [m] RMS of the targets about their rigid fit
};

struct PoseMeasurement {
  PoseStatus status = PoseStatus::target_not_measured;
  int camera = -1, target = -1;  ///< where it failed; -1: not of one
  TargetStatus target_status = TargetStatus::ok;
  Pose X_WT = Pose::Identity();
  /// (translation of T's origin [m], rotation vector [rad]), axes of W, see fit_covariance().
  Mat6 covariance = Mat6::Zero();  ///< from one measurement to the next: detection in these pictures
  Mat6 systematic = Mat6::Zero();  ///< common to all measurements: the cameras' calibration
  /// What each replica of the cameras sees, less the pose: replica r is the same cameras in all measurements.
  std::vector<Twist> replicas;
  double gap = 0;        ///< [m], the widest between two view rays
  double beyond = 0;     ///< [m], the farthest outside of the layers: view rays are extrapolated
  double shape_rms = 0;  ///< [m]

  /// What the pose's error has for a single measurement.
  Mat6 total() const { return covariance + systematic; }
};

PoseMeasurement measure_pose(const StereoModel& model, const std::array<Vec3, 3>& targets_T,
                             const std::array<std::array<PixelPoint, 3>, 2>& seen,
                             const PoseOptions& options = {});

/// From the measured outlines; a target that could not be measured is reported with its reason.
PoseMeasurement measure_pose(const StereoModel& model, const std::array<Vec3, 3>& targets_T,
                             const std::array<TargetsMeasurement, 2>& seen, const PoseOptions& options = {});

}  // namespace understudy::vision

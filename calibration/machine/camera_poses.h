// Poses of a machine from the pictures of two calibrated cameras (Song 2015, section 4 and appendix B).
#pragma once

#include <string>
#include <vector>

#include "calibration/machine/measurement_table.h"
#include "calibration/machine/measuring_frame.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::calibration {

/// One pose from two pictures, expressed in W.
struct CameraPose {
  std::string failure;             ///< one line; empty when measured
  Pose X_WT = Pose::Identity();    ///< measured
  Mat6 covariance = Mat6::Zero();  ///< as MeasuredPose::covariance; the cameras' share included
  Mat6 detection = Mat6::Zero();   ///< of it what changes from picture to picture
  std::vector<Twist> shared;       ///< the cameras' share, as SharedError::shifts
  double beyond = 0;               ///< [m], a target's farthest distance outside of the layers
  bool ok() const { return failure.empty(); }
};

CameraPose camera_pose(const vision::PoseMeasurement& measured);

/// Takes what all poses share out of their covariances: the frame is left, and returned. Poses that failed
/// stay as they are.
MeasuringFrame take_out_frame(std::vector<CameraPose>& poses);

/// The rows of `commanded` whose poses were measured, with what was measured; `poses` has one for each row,
/// or one that failed.
Measurements measured_table(const Measurements& commanded, std::vector<CameraPose> poses);

}  // namespace understudy::calibration

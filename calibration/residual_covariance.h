#pragma once

#include "calibration/strut_model.h"

namespace understudy::calibration {

/// Covariance of the six strut residuals [m^2] that the error of the measured pose makes: J S J^T, with the
/// rows of J those of docs/reference.md#whitening over twice the strut's length.
inline Mat6 residual_covariance(const StrutLinearisation& at, const PoseSample& sample) {
  return at.by_pose * sample.covariance * at.by_pose.transpose();
}

}  // namespace understudy::calibration

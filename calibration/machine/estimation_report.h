// Private to this folder: what hexapods and chains report alike.
#pragma once

#include "calibration/estimators/estimator.h"
#include "calibration/machine/machine_calibration.h"
#include "calibration/machine/measurement_table.h"

namespace understudy::calibration {

/// Throws InputError unless `found` is ok: with the line of the pose at fault, or with the name of the
/// plug-in that gave no answer.
void check_found(const Estimation& found, const Measurements& measurements, const std::string& estimator);

/// Line, use, residual and whitened residual of sample j; `before` is left.
PoseResidual pose_residual(const Estimation& found, const Mat6& covariance, std::size_t j, int line);

/// Statistics and warnings, and the greatest correlation of a covariance that may be empty.
void report_estimation(const Estimation& found, const Eigen::MatrixXd& covariance,
                       MachineCalibration& result);

/// 1 sigma of parameter k [its SI unit]; NaN where the covariance is empty.
double sigma_of(const Eigen::MatrixXd& covariance, std::size_t k);

/// Where the measured tips have their middle, in W.
Vec3 middle_of_tips(const Measurements& measurements);

}  // namespace understudy::calibration

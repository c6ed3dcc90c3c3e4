#include "calibration/machine/estimation_report.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace understudy::calibration {

void check_found(const Estimation& found, const Measurements& measurements, const std::string& estimator) {
  if (found.ok()) return;
  if (found.status == Status::no_answer) throw InputError(estimator + ": " + found.message);
  const int line = found.pose ? measurements.poses.at(*found.pose).line : 0;
  throw InputError({measurements.file, line, 0}, found.message);
}

PoseResidual pose_residual(const Estimation& found, const Mat6& covariance, std::size_t j, int line) {
  PoseResidual residual;
  residual.line = line;
  residual.used = found.used[j];
  residual.after = found.residuals[j];
  residual.whitened = covariance.llt().matrixL().solve(residual.after);
  return residual;
}

void report_estimation(const Estimation& found, const Eigen::MatrixXd& covariance,
                       MachineCalibration& result) {
  if (covariance.size() > 0) {
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    correlation.diagonal().setZero();
    result.correlation_max = correlation.cwiseAbs().maxCoeff();
  }
  result.chi_square = found.chi_square;
  result.degrees_of_freedom = found.degrees_of_freedom;
  result.iterations = found.iterations;
  result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
}

double sigma_of(const Eigen::MatrixXd& covariance, std::size_t k) {
  const auto row = static_cast<Eigen::Index>(k);
  return row < covariance.rows() ? std::sqrt(covariance(row, row)) : std::numeric_limits<double>::quiet_NaN();
}

Vec3 middle_of_tips(const Measurements& measurements) {
  Vec3 middle = Vec3::Zero();
  for (const MeasuredPose& pose : measurements.poses)
    middle += pose.X_WT.translation() / static_cast<double>(measurements.poses.size());
  return middle;
}

}  // namespace understudy::calibration

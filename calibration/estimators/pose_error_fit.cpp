#include "calibration/estimators/pose_error_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "calibration/calibrated.h"
#include "calibration/estimators/whitened_residuals.h"
#include "calibration/identifiability.h"

namespace understudy::calibration {

PoseErrorObjective::PoseErrorObjective(const Problem& problem)
    : samples_(problem.samples), errors_(problem.samples.size(), Twist::Zero()) {
  constexpr double kForward = 1e-13;  // [m] and [rad] to which forward kinematics is good
  for (const PoseSample& sample : samples_) {
    const Eigen::SelfAdjointEigenSolver<Mat6> axes(sample.covariance, Eigen::EigenvaluesOnly);
    rounding_ = std::max(rounding_, kForward / std::sqrt(axes.eigenvalues()[0]));
    weights_.push_back(sample.covariance.llt().solve(Mat6::Identity()));
    reached_.push_back(sample.X_BT);
  }
}

bool PoseErrorObjective::term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) {
  const PoseSample& sample = samples_[j];
  const auto forward = kinematics::forward(machine.geometry, strut_lengths(machine, sample), reached_[j]);
  if (forward.status != kinematics::SolveStatus::ok) return false;
  if (!linearise(machine, sample, forward.X_BT, term.at)) return false;
  reached_[j] = forward.X_BT;
  errors_[j] = pose_error(sample.X_BT, forward.X_BT);
  Mat6 K = term.at.by_pose.partialPivLu().inverse();
  K.bottomRows<3>() = inverse_right_jacobian(errors_[j].tail<3>()) * K.bottomRows<3>().eval();
  const Mat6 weighed = K.transpose() * weights_[j];
  term.M.noalias() = weighed * K;
  term.v.noalias() = weighed * errors_[j];
  term.cost = distance(j);
  return true;
}

Calibration maximum_likelihood(const Problem& problem, const Unknowns& unknowns, const Options& options) {
  const Identifiability found = check_identifiability(problem, unknowns);
  if (found.status != Status::ok) return refused(problem, found);
  const std::vector<bool> all(problem.samples.size(), true);
  // One step at the measured poses lands within micrometres, without forward kinematics from afar.
  WhitenedResiduals at_measured(problem);
  const Fit first = fit(at_measured, search_start(problem, unknowns), unknowns, all, 1);
  PoseErrorObjective objective(problem);
  Fit last = fit(objective, first.machine, unknowns, all, options.max_iterations - first.iterations);
  last.iterations += first.iterations;
  Calibration result = calibrated(problem, last, unknowns, all);
  result.warnings.insert(result.warnings.begin(), found.warnings.begin(), found.warnings.end());
  return result;
}

}  // namespace understudy::calibration

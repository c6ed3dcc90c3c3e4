#include "calibration/estimators/whitened_residuals.h"

#include <Eigen/Cholesky>

#include "calibration/residual_covariance.h"

namespace understudy::calibration {

bool WhitenedResiduals::term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) {
  if (!linearise(machine, samples_[j], samples_[j].X_BT, term.at)) return false;
  const Eigen::LLT<Mat6> factors(residual_covariance(term.at, samples_[j]));
  if (factors.info() != Eigen::Success) return false;
  term.M = factors.solve(Mat6::Identity());
  term.v.noalias() = term.M * term.at.residual;
  term.cost = term.at.residual.dot(term.v);
  return true;
}

}  // namespace understudy::calibration

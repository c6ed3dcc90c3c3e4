// The likelihood of measured poses: measured = forward(parameters, displacements) + noise, so
//   cost = sum over poses of e^T S^-1 e,   e = (p_m - p, log(R_m R^T)),   (p, R) = forward kinematics.
// Its derivative by the parameters is that of the strut equation, f(pose, parameters) = 0 kept:
//   de = Q J^-1 (d f / d parameters), J = d f / d pose, Q = (1, inverse right Jacobian of e's rotation).
#pragma once

#include "calibration/estimators/fit.h"

namespace understudy::calibration {

class PoseErrorObjective final : public Objective {
 public:
  explicit PoseErrorObjective(const Problem& problem);
  bool term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) override;
  double rounding() const override { return rounding_; }

  /// Of sample j at the last machine asked about: measured less reached, and e^T S^-1 e.
  const Twist& error(std::size_t j) const { return errors_[j]; }
  double distance(std::size_t j) const { return errors_[j].dot(weights_[j] * errors_[j]); }

 private:
  const std::vector<PoseSample>& samples_;
  std::vector<Mat6> weights_;  // S^-1
  std::vector<Pose> reached_;  // seeds of the next forward kinematics
  std::vector<Twist> errors_;
  double rounding_ = 0;
};

/// Checks, then maximises the likelihood over all samples.
Calibration maximum_likelihood(const Problem& problem, const Unknowns& unknowns, const Options& options);

}  // namespace understudy::calibration

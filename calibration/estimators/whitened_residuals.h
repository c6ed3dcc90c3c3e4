// The strut-length residual with the six of each pose weighed by the inverse of their covariance, J S J^T
// (docs/reference.md#whitening): one strut's residual tells of all six pose errors, so they are correlated
// and unequal. Reaches the efficiency of maximum likelihood without forward kinematics.
#pragma once

#include "calibration/estimators/fit.h"

namespace understudy::calibration {

class WhitenedResiduals final : public Objective {
 public:
  explicit WhitenedResiduals(const Problem& problem) : samples_(problem.samples) {}
  bool term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) override;
  // The weights turn with the struts' directions: a whole step that moves them is no failure.
  double growth() const override { return 1.5; }

 private:
  const std::vector<PoseSample>& samples_;
};

}  // namespace understudy::calibration

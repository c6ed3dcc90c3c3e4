// Bundle adjustment by Gauss-Newton, with Levenberg's damping where a whole step makes things worse: maximum
// likelihood over all unknowns of a BundleProblem, tolerances as prior knowledge.
#pragma once

#include <string>

#include "calibration/bundle/bundle_problem.h"

namespace understudy::calibration {

struct BundleAdjustment {
  Status status = Status::not_converged;
  std::string message;  ///< one line; empty when ok
  BundleState state;    ///< the last iterate where not converged
  /// Of the machine (calibration/problem.h), then of the leads [1] and of the warming [m] where they are
  /// unknown; empty unless ok. What the boards leave open of frame W is in it.
  Eigen::MatrixXd covariance;
  double chi_square = 0;  ///< of pixels, strut lengths and prior knowledge
  long degrees_of_freedom = 0;
  int iterations = 0;
  bool ok() const { return status == Status::ok; }
};

/// Never throws for data: `status` and `message` say what is missing.
BundleAdjustment adjust_bundle(const BundleProblem& problem, const Options& options = {});

/// Cramer-Rao bound of the same numbers, for the true `state`; empty where they cannot be told apart.
Eigen::MatrixXd bundle_bound(const BundleProblem& problem, const BundleState& state);

}  // namespace understudy::calibration

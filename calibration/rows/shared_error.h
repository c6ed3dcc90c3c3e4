// What rows of one pose of the machine get wrong together: play, bending and a drive's error move every
// target on the tool alike, which no noise of the measuring device says.
#pragma once

#include "calibration/rows/row_fit.h"

namespace understudy::calibration {

struct SharedError {
  double share = 0;  ///< correlation between rows of one pose, 0 to 1; 0 where it is not significant
  Eigen::MatrixXd covariance;  ///< of the fit's unknowns, with it
};

/// Rows of equal readings, kind and frame, against the fit that took them for independent. The estimate
/// stays; its covariance is that of rows that are correlated so (Liang and Zeger 1986, exchangeable
/// correlation).
SharedError shared_error(const RowProblem& problem, const SurroundingsLayout& layout,
                         const std::vector<Eigen::Index>& unknowns, const RowFit& fit,
                         const AddedNoise& noise, const RowWeights& weights);

}  // namespace understudy::calibration

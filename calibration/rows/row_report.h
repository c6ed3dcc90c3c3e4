// Private to this folder: what a fit of rows says to its user.
#pragma once

#include "calibration/rows/calibrate_rows.h"

namespace understudy::calibration {

/// RMS of each part that the rows have. `before`, `after`: errors of all equations.
std::vector<PartReport> part_reports(const RowProblem& problem, const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after, const AddedNoise& added);

/// Numbers of the surroundings, named as the layout's columns; the last rows of `covariance` are theirs.
std::vector<FoundNumber> found_numbers(const SurroundingsLayout& layout, const Surroundings& around,
                                       const Eigen::MatrixXd& covariance);

}  // namespace understudy::calibration

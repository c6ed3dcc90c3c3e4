// Private to this folder: what a fit of rows says to its user.
#pragma once

#include "calibration/rows/calibrate_rows.h"

namespace understudy::calibration {

/// RMS of each part that the rows have. `before`, `after`: errors of all equations.
std::vector<PartReport> part_reports(const RowProblem& problem, const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after, const AddedNoise& added,
                                     const RowWeights& weights = {});

/// Rows of weight 0. `apart`, `after`: of the fit.
std::vector<SpoiledRow> spoiled_list(const RowProblem& problem, const RowFit& fit, const RowWeights& weights);

/// What rows tell of the machine's parameters less than `prior` did: single ones, then combinations of the
/// others. `covariance` is theirs.
void name_untold(const std::vector<std::string>& names, const Eigen::MatrixXd& covariance,
                 const Eigen::VectorXd& prior, RowCalibration& result);

/// Of targets whose positions rows tell.
std::vector<TargetSigma> target_sigmas(const RowProblem& problem, const SurroundingsLayout& layout,
                                       const std::vector<Eigen::Index>& unknowns, const RowFit& fit);

/// Numbers of the surroundings, named as the layout's columns; the last rows of `covariance` are theirs.
std::vector<FoundNumber> found_numbers(const SurroundingsLayout& layout, const Surroundings& around,
                                       const Eigen::MatrixXd& covariance);

}  // namespace understudy::calibration

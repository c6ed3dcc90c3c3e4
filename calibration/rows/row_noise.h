// How much measured rows scatter: what their file tells, and what the residuals tell beyond it.
#pragma once

#include <array>
#include <vector>

#include "calibration/rows/row_equations.h"

namespace understudy::calibration {

/// Equations that scatter alike.
enum class NoisePart { position, turn, distance, point, plane, exact };
constexpr std::size_t kNoiseParts = 5;  ///< `exact`, of known distances, has its own sigma only

/// 1 sigma [m] or [rad] on each axis, added in squares to what rows tell of themselves.
using AddedNoise = std::array<double, kNoiseParts>;

/// How much each row counts in a fit, 0 to 1; empty: all of them 1.
using RowWeights = std::vector<double>;
inline double weight_of(const RowWeights& weights, std::size_t row) {
  return weights.empty() ? 1.0 : weights[row];
}

/// The part of every equation.
std::vector<NoisePart> parts_of(const RowProblem& problem);

/// Equations of each row, and of each known distance, divided by the root of their covariance.
void whiten(const RowProblem& problem, const AddedNoise& added, RowEquations& equations);

/// One part's equations against the noise.
struct PartScatter {
  int equations = 0;
  double degrees = 0;  ///< equations less what the fitted unknowns have taken of them
  double told = 0;     ///< sum of squares of residuals by their told noise; infinite where some tell none
  bool all_told = true;
};

/// From residuals and their share of the fit: `fitted` are the variances of the model's own values, one an
/// equation, in SI. Rows of weight 0 are passed over.
std::array<PartScatter, kNoiseParts> scatter(const RowProblem& problem, const Eigen::VectorXd& error,
                                             const Eigen::VectorXd& fitted, const AddedNoise& added,
                                             const RowWeights& weights = {});

/// The noise that makes each part's residuals what they should be on average (Mandel and Paule 1970): 0 where
/// the told noise explains them. A part without a degree of freedom keeps its noise.
AddedNoise explaining_noise(const RowProblem& problem, const Eigen::VectorXd& error,
                            const Eigen::VectorXd& fitted, const AddedNoise& before,
                            const RowWeights& weights = {});

/// Likewise from the median of each part's residuals, which fewer than half of the rows cannot spoil.
AddedNoise median_noise(const RowProblem& problem, const Eigen::VectorXd& error,
                        const Eigen::VectorXd& fitted, const AddedNoise& before);

}  // namespace understudy::calibration

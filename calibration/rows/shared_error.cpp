#include "calibration/rows/shared_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kSignificant = 3;  // standard deviations of the sum over pairs of independent rows

/// Rows of one pose, of each pose that has several.
std::vector<std::vector<std::size_t>> rows_of_poses(const RowProblem& problem, const RowWeights& weights) {
  std::map<std::tuple<RowKind, std::string, std::vector<double>>, std::vector<std::size_t>> groups;
  for (std::size_t j = 0; j < problem.rows.size(); ++j) {
    const MeasurementRow& row = problem.rows[j];
    if (weight_of(weights, j) > 0) groups[{row.kind, row.frame, row.axes}].push_back(j);
  }
  std::vector<std::vector<std::size_t>> several;
  for (auto& [pose, rows] : groups)
    if (rows.size() > 1) several.push_back(std::move(rows));
  return several;
}

}  // namespace

SharedError shared_error(const RowProblem& problem, const SurroundingsLayout& layout,
                         const std::vector<Index>& unknowns, const RowFit& fit, const AddedNoise& noise,
                         const RowWeights& weights) {
  SharedError shared{0, fit.covariance};
  const Index columns = fit.covariance.cols(), machine = columns - layout.columns();
  const auto poses = rows_of_poses(problem, weights);
  if (poses.empty() || columns == 0) return shared;
  RowEquations equations = row_equations(problem, layout, fit.state, machine > 0);
  whiten(problem, noise, equations);
  const MatrixXd J = jacobian(equations, unknowns);
  const auto first = first_equations(problem);
  double products = 0, taken = 0, count = 0;  // over pairs: of residuals, what the fit took of them, how many
  MatrixXd between = MatrixXd::Zero(columns, columns);
  for (const std::vector<std::size_t>& rows : poses) {
    const Index n = equations_of(problem.rows[rows.front()].kind);
    Eigen::VectorXd error = Eigen::VectorXd::Zero(n);
    MatrixXd sum = MatrixXd::Zero(n, columns);
    for (const std::size_t j : rows) {
      const auto own = J.middleRows(first[j], n);
      const auto own_error = equations.error.segment(first[j], n);
      error += own_error;
      sum += own;
      products -= own_error.squaredNorm() / 2;
      taken -= (own * fit.covariance).cwiseProduct(own).sum() / 2;
      between -= own.transpose() * own;
    }
    products += error.squaredNorm() / 2;
    taken += (sum * fit.covariance).cwiseProduct(sum).sum() / 2;
    between += sum.transpose() * sum;
    count += static_cast<double>(n) * static_cast<double>(rows.size() * (rows.size() - 1)) / 2;
  }
  // Residuals of independent rows are correlated by -(what the fit took).
  if (products + taken < kSignificant * std::sqrt(count)) return shared;
  shared.share = std::min(1.0, (products + taken) / count);
  shared.covariance += shared.share * fit.covariance * between * fit.covariance;
  shared.covariance = 0.5 * (shared.covariance + shared.covariance.transpose()).eval();
  return shared;
}

}  // namespace understudy::calibration

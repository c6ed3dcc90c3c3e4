#include "calibration/estimators/independent_columns.h"

namespace understudy::calibration {

std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& J) {
  // Relative to the whole column: what is left of a redundant one is rounding, of a poor one 1e-3 and more.
  constexpr double kRedundant = 1e-6;
  Eigen::MatrixXd columns(J.rows(), J.cols());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < J.cols(); ++k) {
    const auto basis = columns.leftCols(static_cast<Eigen::Index>(kept.size()));
    const double whole = J.col(k).norm();
    Eigen::VectorXd rest = J.col(k);
    for (int twice = 0; twice < 2; ++twice) rest -= basis * (basis.transpose() * rest);
    if (!(rest.norm() > kRedundant * whole)) continue;
    columns.col(basis.cols()) = rest.normalized();
    kept.push_back(k);
  }
  return kept;
}

}  // namespace understudy::calibration

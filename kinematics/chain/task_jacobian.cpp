#include "kinematics/chain/task_jacobian.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace understudy::kinematics {
namespace {

/// A pivot below this share of the largest is a direction that the axes do not move.
constexpr double kRankTolerance = 1e-9;

/// A square J of which this is a bound of the condition number is solved by elimination: what is lost is
/// 1e-10 of the solution.
constexpr double kWellConditioned = 1e6;

/// Column per dimension of the task, row per axis.
using TransposedJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxAxes, kTaskMax>;

/// Never below the condition number of a square J: the product of all singular values is |det J|, and of all
/// but the smallest it is largest for a given norm where they are equal (inequality of the means).
double bound_of_condition(const TaskJacobian& J, double determinant) {
  const double norm = J.norm();
  const auto others = static_cast<double>(J.rows() - 1);
  return norm * std::pow(norm / std::sqrt(std::max(others, 1.0)), others) / std::abs(determinant);
}

/// J P = Q R, and the rows of R that are not lost as (Z T)^T: y = P Z T^-T Q^T wanted (Golub, Van Loan,
/// Matrix Computations, 5.5). Eigen's CompleteOrthogonalDecomposition does the same but allocates.
template <typename Wanted, typename Solution>
bool solve_by_pivots(const TaskJacobian& J, const Wanted& wanted, Solution& y) {
  Eigen::ColPivHouseholderQR<TaskJacobian> qr(J);
  qr.setThreshold(kRankTolerance);
  const Eigen::Index rank = qr.rank();
  y = Solution::Zero(J.cols(), wanted.cols());
  if (rank == 0) return false;
  Wanted c = wanted;
  c.applyOnTheLeft(qr.householderQ().adjoint());
  const TaskJacobian kept = qr.matrixR().topRows(rank).template triangularView<Eigen::Upper>();
  const Eigen::HouseholderQR<TransposedJacobian> z(kept.transpose());
  const auto T = z.matrixQR().topRows(rank).template triangularView<Eigen::Upper>();
  y.topRows(rank) = c.topRows(rank);
  T.transpose().solveInPlace(y.topRows(rank));
  y.applyOnTheLeft(z.householderQ());
  y = (qr.colsPermutation() * y).eval();
  return rank == J.rows();
}

template <typename Wanted, typename Solution>
bool solve(const TaskJacobian& J, const Wanted& wanted, Solution& y) {
  if (J.rows() == J.cols()) {
    const Eigen::PartialPivLU<TaskJacobian> lu(J);
    if (bound_of_condition(J, lu.determinant()) < kWellConditioned) {
      y = lu.solve(wanted);
      return true;
    }
  }
  return solve_by_pivots(J, wanted, y);
}

}  // namespace

bool solve_minimum_norm(const TaskJacobian& J, const TaskColumn& wanted, AxisColumn& y) {
  return solve(J, wanted, y);
}

bool solve_minimum_norm(const TaskJacobian& J, const TaskRows& wanted, AxisRows& y) {
  return solve(J, wanted, y);
}

double condition_number(const TaskJacobian& J, double worst) {
  const Eigen::JacobiSVD<TaskJacobian> svd(J);
  const auto& values = svd.singularValues();
  const double smallest = J.cols() < J.rows() ? 0.0 : values(J.rows() - 1);
  return smallest * worst > values(0) ? values(0) / smallest : worst;
}

}  // namespace understudy::kinematics

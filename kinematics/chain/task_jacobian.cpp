#include "kinematics/chain/task_jacobian.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace understudy::kinematics {
namespace {

/// A singular value below this share of the largest is a direction that the axes do not move.
constexpr double kRankTolerance = 1e-9;

/// A square J of which this is a bound of the condition number is solved without singular values: what is
/// lost is 1e-10 of the solution.
constexpr double kWellConditioned = 1e6;

using Decomposition = Eigen::JacobiSVD<TaskJacobian>;

/// Never below the condition number of a square J: the product of all singular values is |det J|, and of all
/// but the smallest it is largest for a given norm where they are equal (inequality of the means).
double bound_of_condition(const TaskJacobian& J, double determinant) {
  const double norm = J.norm();
  const auto others = static_cast<double>(J.rows() - 1);
  return norm * std::pow(norm / std::sqrt(std::max(others, 1.0)), others) / std::abs(determinant);
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
  Decomposition svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(kRankTolerance);
  y = svd.solve(wanted);
  return svd.rank() == J.rows();
}

}  // namespace

bool solve_by_singular_values(const TaskJacobian& J, const TaskColumn& wanted, AxisColumn& y) {
  return solve(J, wanted, y);
}

bool solve_by_singular_values(const TaskJacobian& J, const TaskRows& wanted, AxisRows& y) {
  return solve(J, wanted, y);
}

double condition_number(const TaskJacobian& J, double worst) {
  const Decomposition svd(J);
  const auto& values = svd.singularValues();
  const double smallest = J.cols() < J.rows() ? 0.0 : values(J.rows() - 1);
  return smallest * worst > values(0) ? values(0) / smallest : worst;
}

}  // namespace understudy::kinematics

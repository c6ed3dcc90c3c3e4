#include "kinematics/chain/task_jacobian.h"

#include <Eigen/SVD>

namespace understudy::kinematics {
namespace {

/// A singular value below this share of the largest is a direction that the axes do not move.
constexpr double kRankTolerance = 1e-9;

using Decomposition = Eigen::JacobiSVD<TaskJacobian>;

template <typename Wanted, typename Solution>
bool solve(const TaskJacobian& J, const Wanted& wanted, Solution& y) {
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

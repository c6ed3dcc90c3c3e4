#include "kinematics/chain/minimum_norm.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "kinematics/chain/task_jacobian.h"

namespace understudy::kinematics {
namespace {

constexpr int kTask = 5;
/// Pivots of J J^T, smallest to largest: above it some 12 digits of the solution are left.
constexpr double kNormalPivots = 1e-4;

using TipAndAxisRows = Eigen::Matrix<double, kTask, 6>;
using TipAndAxis = Eigen::Matrix<double, kTask, 1>;
using TipAndAxisJacobian = Eigen::Matrix<double, kTask, Eigen::Dynamic, 0, kTask, kMaxAxes>;

bool finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// From twists to the task, angles as lengths.
TipAndAxisRows task_rows(const Pose& X_ST, double metric) {
  TipAndAxisRows rows = TipAndAxisRows::Zero();
  rows.topLeftCorner<3, 3>().setIdentity();
  rows.block<1, 3>(3, 3) = metric * X_ST.linear().col(0).transpose();
  rows.block<1, 3>(4, 3) = metric * X_ST.linear().col(1).transpose();
  return rows;
}

/// The smallest y with J y = wanted, or nearest to it where J has lost rank: then false.
bool smallest_solution(const TipAndAxisJacobian& J, const TipAndAxis& wanted, AxisColumn& y) {
  // Normal equations halve the digits of an ill-conditioned J, but are ten times quicker where it is not.
  const Eigen::LDLT<Eigen::Matrix<double, kTask, kTask>> normal(J * J.transpose());
  const TipAndAxis pivots = normal.vectorD();
  if (normal.info() == Eigen::Success && pivots.minCoeff() > kNormalPivots * pivots.maxCoeff()) {
    y = J.transpose() * normal.solve(wanted);
    return true;
  }
  return solve_minimum_norm(J, wanted, y);
}

/// From here on to the end of half a range its weight grows.
constexpr double kFree = 0.8;
constexpr double kAtEnd = 0.99;  // of that way: farther out the weight stays what it is here, 10^4

}  // namespace

double range_weight(const ChainAxis& axis, double q) {
  const double half = (axis.upper - axis.lower) / 2;
  if (!std::isfinite(half) || !(half > 0)) return 1;
  const double out = std::abs(q - (axis.lower + half)) / half;
  const double way = std::clamp((out - kFree) / (1 - kFree), 0.0, kAtEnd);
  return 1 + std::pow(way / (1 - way), 2);
}

Twist task_error(const Pose& X_ST, const Pose& X_ST_wanted) {
  Twist error;
  error << X_ST_wanted.translation() - X_ST.translation(), tool_axis(X_ST).cross(tool_axis(X_ST_wanted));
  return error;
}

double tool_axis_angle(const Pose& X_ST, const Pose& X_ST_wanted) {
  const Vec3 a = tool_axis(X_ST), b = tool_axis(X_ST_wanted);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

SolveStatus minimum_norm_rates(const Chain& chain, std::span<const double> axes, const Twist& twist,
                               double metric, std::span<const double> null_space_motion,
                               std::span<double> rates) {
  const std::size_t n = chain.axes.size();
  const bool some_motion = !null_space_motion.empty();
  if (axes.size() < n || rates.size() < n || (some_motion && null_space_motion.size() < n) ||
      !finite(axes.first(n)) || !twist.allFinite() || !(metric > 0) || !std::isfinite(metric) ||
      (some_motion && !finite(null_space_motion.first(n))))
    return SolveStatus::bad_input;
  ChainJacobian J;
  const TipAndAxisRows rows = task_rows(forward(chain, axes, J), metric);
  // In y = W q, with W = metric for angles and 1 for slides, more at ends of ranges, the norm is the plain
  // one.
  AxisColumn weight(chain.size()), y_null = AxisColumn::Zero(chain.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    weight[k] = (chain.axes[i].angle ? metric : 1.0) * range_weight(chain.axes[i], axes[i]);
    if (some_motion) y_null[k] = weight[k] * null_space_motion[i];
  }
  TipAndAxisJacobian J_scaled = rows * J;
  for (Eigen::Index k = 0; k < weight.size(); ++k) J_scaled.col(k) /= weight[k];
  const TipAndAxis wanted = rows * twist - J_scaled * y_null;
  AxisColumn y;
  const bool full_rank = smallest_solution(J_scaled, wanted, y);
  y += y_null;
  if (!y.allFinite()) return SolveStatus::bad_input;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    rates[i] = y[k] / weight[k];
  }
  return full_rank ? SolveStatus::ok : SolveStatus::singular;
}

}  // namespace understudy::kinematics

// Levenberg-Marquardt with the damping in proportion to the squared error: far away it is gradient descent,
// near a solution Newton's method, and it needs no rank (Yamashita and Fukushima 2001; Sugihara 2011).
#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

constexpr double kTolerance = 1e-12;     // [m], [rad]: a thousand roundings of a metre
constexpr double kNear = 1e-6;           // [m], [rad]: less than this off is a solution that was not reached
constexpr int kTrialsMax = 100;          // steps tried; a good start takes 5, a singular solution 20 to 40
constexpr int kIdleMax = 4;              // steps in a row that gain nothing
constexpr double kIdle = 1e-4;           // gain of a step that is none, as a share of the squared error
constexpr double kStepMax = 1.0;         // [rad] of any axis in one step
constexpr double kDampingFloor = 1e-16;  // of the squared size of the Jacobian: below, rounding leads

/// Error and derivative of the task: tip, then angles about x, y and z of T as lengths; the last row is zero
/// where the spin is left out.
struct Iterate {
  AxisVector axes{};
  Twist error;
  ChainJacobian J;
  double position = 0, angle = 0;  // [m], [rad]
  double cost() const { return error.squaredNorm(); }
  bool within(double tolerance) const { return position <= tolerance && angle <= tolerance; }
};

/// Turn that brings z of T onto the wanted one by the shortest arc, in T.
Vec3 axis_turn(const Vec3& z_T) {
  const double sine = std::hypot(z_T.x(), z_T.y());
  if (sine == 0) return {z_T.z() < 0 ? std::numbers::pi : 0.0, 0, 0};
  return std::atan2(sine, z_T.z()) / sine * Vec3(-z_T.y(), z_T.x(), 0);
}

void evaluate(const Chain& chain, const Pose& X_goal, bool follows_spin, double scale, Iterate& at) {
  const Pose X = forward(chain, at.axes, at.J);
  const Mat3 R_left = X.linear().transpose() * X_goal.linear();
  const Vec3 turn = follows_spin ? log_rotation(R_left) : axis_turn(R_left.col(2));
  at.error.head<3>() = X_goal.translation() - X.translation();
  at.error.tail<3>() = scale * turn;
  at.position = at.error.head<3>().norm();
  at.angle = turn.norm();
  const Mat3 R_TS = scale * X.linear().transpose();
  for (int i = 0; i < chain.size(); ++i) {
    at.J.col(i).tail<3>() = (R_TS * at.J.col(i).tail<3>()).eval();
    if (chain.axes[i].angle) at.J.col(i) /= scale;
  }
  if (!follows_spin) at.J.row(5).setZero();
}

using SquareOfAxes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxAxes, kMaxAxes>;

/// Of the smallest norm; the smaller of the two square matrices, so that neither is singular by its size.
AxisColumn damped_step(const Iterate& at, double damping, int task_size) {
  if (at.J.cols() >= task_size) {
    Mat6 square = at.J * at.J.transpose();
    square.diagonal().array() += damping;
    return at.J.transpose() * square.ldlt().solve(at.error);
  }
  SquareOfAxes square = at.J.transpose() * at.J;
  square.diagonal().array() += damping;
  return square.ldlt().solve(at.J.transpose() * at.error);
}

/// Per axis in SI again, shortened so that no angle leaps.
void move(const Chain& chain, double scale, AxisColumn step, const Iterate& from, Iterate& to) {
  double largest = 0;
  for (int i = 0; i < chain.size(); ++i)
    if (chain.axes[i].angle) {
      step[i] /= scale;
      largest = std::max(largest, std::abs(step[i]));
    }
  if (largest > kStepMax) step *= kStepMax / largest;
  for (int i = 0; i < chain.size(); ++i) to.axes[i] = from.axes[i] + step[i];
}

}  // namespace

SolveStatus solve_numerically(const Chain& chain, const Pose& X_ST, bool follows_spin, double length_scale,
                              std::span<double> axes) {
  const std::size_t n = chain.axes.size();
  if (axes.size() < n || !is_pose(X_ST)) return SolveStatus::bad_input;
  for (const double q : axes.first(n))
    if (!std::isfinite(q)) return SolveStatus::bad_input;
  // A pose from a file is a rotation to its last digit only; what is left over could never be reached.
  const Pose X_goal = make_pose(Quat(X_ST.linear()), X_ST.translation());

  Iterate at, trial;
  std::copy_n(axes.begin(), n, at.axes.begin());
  evaluate(chain, X_goal, follows_spin, length_scale, at);
  double share = 1e-2;  // of the squared error, relative to the task's size
  int idle = 0;
  for (int i = 0; i < kTrialsMax && idle < kIdleMax && !at.within(kTolerance); ++i) {
    const double size2 = at.J.squaredNorm();
    const double damping = share * at.cost() + kDampingFloor * size2;
    move(chain, length_scale, damped_step(at, damping, follows_spin ? 6 : 5), at, trial);
    evaluate(chain, X_goal, follows_spin, length_scale, trial);
    const double gain = at.cost() - trial.cost();
    idle = gain > kIdle * at.cost() ? 0 : idle + 1;
    share = gain > 0 ? std::max(share / 4, 1e-6) : share * 8;
    if (gain > 0) std::swap(at, trial);
  }
  if (!std::isfinite(at.cost())) return SolveStatus::not_converged;
  std::copy_n(at.axes.begin(), n, axes.begin());
  if (at.within(kTolerance)) return SolveStatus::ok;
  if (at.within(kNear)) return SolveStatus::singular;
  return idle == kIdleMax ? SolveStatus::unreachable : SolveStatus::not_converged;
}

}  // namespace understudy::kinematics

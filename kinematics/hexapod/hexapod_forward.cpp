#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinematics/hexapod/hexapod.h"
#include "kinematics/hexapod/hexapod_newton.h"
#include "kinematics/hexapod/hexapod_numbers.h"
#include "kinematics/rigid_pose.h"

namespace understudy::kinematics {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr double kSmallestStep = 1e-3;  // of the Newton step, before giving up
constexpr double kPivotRatio =
    1e-10;  // of the scaled Jacobian; smaller leaves fewer than 6 digits of the step

// Everything that one iterate needs: residuals, and the factors of J with its angular columns scaled.
struct Iterate {
  Pose X_BT;
  Vec6 residual;
  Eigen::PartialPivLU<Mat6> factors;
  SolveStatus status = SolveStatus::ok;

  double worst() const { return residual.cwiseAbs().maxCoeff(); }
  double det() const { return factors.determinant(); }
};

void evaluate(const HexapodGeometry& geometry, const StrutLengths& target, double radius, Iterate& at) {
  StrutLengths lengths;
  Mat6 J;
  at.status = inverse(geometry, at.X_BT, lengths);
  if (at.status == SolveStatus::ok) at.status = jacobian(geometry, at.X_BT, J);
  if (at.status != SolveStatus::ok) return;
  for (std::size_t i = 0; i < kStruts; ++i)
    at.residual[static_cast<Eigen::Index>(i)] = lengths[i] - target[i];
  J.rightCols<3>() /= radius;
  at.factors.compute(J);
  const Vec6 pivots = at.factors.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > kPivotRatio * pivots.maxCoeff())) at.status = SolveStatus::singular;
}

Twist bounded_newton_step(const Iterate& at, double radius, double travel_max) {
  Twist step = -at.factors.solve(at.residual);
  step.tail<3>() /= radius;
  const double excess = std::max(step.head<3>().norm() / travel_max, step.tail<3>().norm() / kTurnMax);
  return excess > 1 ? Twist(step / excess) : step;
}

Pose moved(const Pose& X, const Twist& step) {
  return make_pose(Mat3(exp_rotation(step.tail<3>()) * X.linear()), X.translation() + step.head<3>());
}

// Shortens the step until the residual falls and the sign of det J stays. The status says what was in the
// way.
SolveStatus advance(const HexapodGeometry& geometry, const StrutLengths& target, double radius,
                    const Twist& step, Iterate& at, Iterate& trial) {
  const double residual = at.residual.norm();
  const double det = at.det();
  SolveStatus obstacle = SolveStatus::not_converged;
  for (double scale = 1; scale >= kSmallestStep; scale /= 2) {
    trial.X_BT = moved(at.X_BT, scale * step);
    evaluate(geometry, target, radius, trial);
    const bool crossed =
        trial.status == SolveStatus::singular || (trial.status == SolveStatus::ok && trial.det() * det <= 0);
    obstacle = crossed ? SolveStatus::singular : SolveStatus::not_converged;
    if (trial.status == SolveStatus::ok && !crossed && trial.residual.norm() < residual) {
      std::swap(at, trial);
      return SolveStatus::ok;
    }
  }
  return obstacle;
}

// The product of many small rotations drifts from orthogonal by rounding; one more turn of this pulls it
// back.
Mat3 orthonormal(const Mat3& R) { return Quat(R).normalized().toRotationMatrix(); }

/// Step by step with the brakes on: where whole steps do not do.
void forward_with_care(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& seed,
                       const ForwardOptions& options, ForwardResult& result) {
  const double radius = platform_radius(geometry);
  double mean_length = 0;
  for (const double l : lengths) mean_length += l / kStruts;
  Iterate at, trial;
  at.X_BT = make_pose(orthonormal(seed.linear()), seed.translation());
  evaluate(geometry, lengths, radius, at);
  result.X_BT = at.X_BT;
  result.status = at.status;
  if (at.status == SolveStatus::unreachable || at.status == SolveStatus::bad_input) return;
  while (result.status == SolveStatus::ok && at.worst() > options.tolerance) {
    if (result.iterations == options.max_iterations) {
      result.status = SolveStatus::not_converged;
      break;
    }
    ++result.iterations;
    const Twist step = bounded_newton_step(at, radius, kTravelMax * mean_length);
    result.status = advance(geometry, lengths, radius, step, at, trial);
  }
  result.X_BT = make_pose(orthonormal(at.X_BT.linear()), at.X_BT.translation());
  result.residual = at.worst();
}

}  // namespace

ForwardResult forward(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& seed,
                      const ForwardOptions& options) {
  const auto usable = [](double l) { return std::isfinite(l) && l > 0; };
  if (!std::all_of(lengths.begin(), lengths.end(), usable))
    return {SolveStatus::bad_input, is_rigid(seed) ? seed : Pose::Identity()};
  double target[kStruts];
  std::copy(lengths.begin(), lengths.end(), target);
  const auto quick =
      simd::newton(plain_numbers(geometry), target, plain_numbers(seed), newton_settings(options));
  if (quick.ok)
    return {SolveStatus::ok, pose_of(quick.X), static_cast<int>(quick.iterations), quick.residual};
  ForwardResult result;
  if (is_rigid(seed))
    forward_with_care(geometry, lengths, seed, options, result);
  else
    result.status = SolveStatus::bad_input;
  return result;
}

}  // namespace understudy::kinematics

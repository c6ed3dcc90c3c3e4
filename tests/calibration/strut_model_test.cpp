// Every derivative against central differences of what it is the derivative of.
#include <gtest/gtest.h>

#include "calibration/estimators/fit.h"
#include "tests/calibration/calibration_rig.h"

namespace understudy::calibration {
namespace {

constexpr double kStep = 1e-6;  // [m], [rad]: truncation 1e-12, rounding 1e-16 / 1e-6
constexpr double kClose = 1e-8;

PoseSample sample_with_approaches() {
  PoseSample sample = make_case(3, 1).exact[0];
  for (std::size_t i = 0; i < kStruts; ++i)
    sample.approach[i] = i % 2 == 0 ? Approach::lengthening : Approach::shortening;
  return sample;
}

Vec6 residual(const HexapodParameters& machine, const PoseSample& sample, const Pose& X_BT) {
  StrutLinearisation at;
  EXPECT_TRUE(linearise(machine, sample, X_BT, at));
  return at.residual;
}

ParameterVector step_along(Eigen::Index k, double step) {
  ParameterVector by = ParameterVector::Zero(kMaxParameters);
  by[k] = step;
  return by;
}

TEST(StrutModel, ResidualIsZeroOnTheTrueMachine) {
  const Case c = make_case(1, 5);
  for (const PoseSample& sample : c.exact)
    EXPECT_LT(residual(c.truth, sample, sample.X_BT).cwiseAbs().maxCoeff(), 1e-15);  // rounding of 0.2 m
}

TEST(StrutModel, DerivativesByParametersAreThoseOfTheResidual) {
  const Unknowns all{.deviation = true, .play = true};
  const PoseSample sample = sample_with_approaches();
  const HexapodParameters machine = {rig().nominal, {40e-6, 50e-6, 60e-6, 70e-6, 80e-6, 90e-6}};
  StrutLinearisation at;
  ASSERT_TRUE(linearise(machine, sample, sample.X_BT, at));
  const auto rows = dense_rows(at, all);
  for (Eigen::Index k = 0; k < all.count(); ++k) {
    const Vec6 after = residual(moved(machine, step_along(k, kStep), all), sample, sample.X_BT);
    const Vec6 before = residual(moved(machine, step_along(k, -kStep), all), sample, sample.X_BT);
    EXPECT_LT(((after - before) / (2 * kStep) - rows.col(k)).cwiseAbs().maxCoeff(), kClose)
        << "unknown " << k;
  }
}

TEST(StrutModel, DerivativesByPoseAreThoseOfTheResidual) {
  const PoseSample sample = sample_with_approaches();
  StrutLinearisation at;
  ASSERT_TRUE(linearise({rig().nominal, {}}, sample, sample.X_BT, at));
  for (int k = 0; k < 6; ++k) {
    Vec6 change = Vec6::Zero();
    for (const double sign : {1.0, -1.0}) {
      Pose X = sample.X_BT;
      if (k < 3)
        X.translation()[k] += sign * kStep;
      else
        X.linear() = exp_rotation(sign * kStep * Vec3::Unit(k - 3)) * X.linear();
      change += sign * residual({rig().nominal, {}}, sample, X) / (2 * kStep);
    }
    EXPECT_LT((change - at.by_pose.col(k)).cwiseAbs().maxCoeff(), kClose) << "pose coordinate " << k;
  }
}

// What the drives make of changed parameters, by forward kinematics.
TEST(StrutModel, PoseRowsAreTheDerivativeOfForwardKinematics) {
  const Unknowns all{.deviation = true, .play = true};
  PoseSample sample = sample_with_approaches();
  const HexapodParameters machine = {rig().nominal, {}};
  const auto reached = [&](const HexapodParameters& m) {
    return kinematics::forward(m.geometry, strut_lengths(m, sample), sample.X_BT).X_BT;
  };
  sample.X_BT = reached(machine);
  StrutLinearisation at;
  ASSERT_TRUE(linearise(machine, sample, sample.X_BT, at));
  const auto rows = pose_rows(at, all);
  for (Eigen::Index k = 0; k < all.count(); ++k) {
    const Pose after = reached(moved(machine, step_along(k, kStep), all));
    const Pose before = reached(moved(machine, step_along(k, -kStep), all));
    Vec6 change;
    change << after.translation() - before.translation(),
        log_rotation(after.linear() * before.linear().transpose());
    // Forward kinematics is good to 1e-13 m and the platform turns it into 1e-11 rad: 1e-5 of a step.
    EXPECT_LT((change / (2 * kStep) - rows.col(k)).cwiseAbs().maxCoeff(), 3e-5) << "unknown " << k;
  }
}

TEST(StrutModel, InverseRightJacobianIsTheDerivativeOfTheLogarithm) {
  for (const double size : {1e-7, 3e-3, 0.02, 0.5, 2.0}) {
    const Vec3 e = size * Vec3(0.36, -0.48, 0.8);
    const Mat3 Q = inverse_right_jacobian(e);
    for (int k = 0; k < 3; ++k) {
      const Mat3 step = exp_rotation(kStep * Vec3::Unit(k));
      const Vec3 change =
          (log_rotation(exp_rotation(e) * step) - log_rotation(exp_rotation(e) * step.transpose())) /
          (2 * kStep);
      EXPECT_LT((change - Q.col(k)).cwiseAbs().maxCoeff(), 1e-8) << "angle " << size;
    }
  }
}

TEST(StrutModel, AStrutShorterThanDevHasNoLength) {
  HexapodParameters machine{rig().nominal, {}};
  machine.geometry.deviation = 0.3;
  StrutLinearisation at;
  EXPECT_FALSE(linearise(machine, {}, rig().machine.X_BT_home, at));
}

// The sparse sum against the dense one.
TEST(NormalEquations, BlocksAreTheDenseProduct) {
  const Case c = make_case(5, 9);
  for (const Unknowns unknowns : {Unknowns{}, Unknowns{.deviation = true, .play = true}}) {
    NormalEquations sum(unknowns);
    ParameterMatrix dense = ParameterMatrix::Zero(unknowns.count(), unknowns.count());
    ParameterVector gradient = ParameterVector::Zero(unknowns.count());
    Random random(7, "weights");
    for (PoseSample sample : c.exact) {
      Mat6 root;
      Vec6 v;
      for (double& x : root.reshaped()) x = random.normal();
      for (double& x : v) x = random.normal();
      for (Approach& a : sample.approach)
        a = random.normal() > 0 ? Approach::lengthening : Approach::shortening;
      const Mat6 M = root * root.transpose();
      StrutLinearisation at;
      ASSERT_TRUE(linearise(c.truth, sample, sample.X_BT, at));
      sum.add(at, M, v);
      const auto rows = dense_rows(at, unknowns);
      dense += rows.transpose() * M * rows;
      gradient += rows.transpose() * v;
    }
    EXPECT_LT((sum.information() - dense).cwiseAbs().maxCoeff(), 1e-13 * dense.cwiseAbs().maxCoeff());
    ParameterVector step;
    ASSERT_TRUE(sum.solve(0, step));
    // Backward stable: the residual is rounding of H times the step.
    EXPECT_LT((dense * step + gradient).norm(), 1e-12 * dense.norm() * step.norm());
    EXPECT_NEAR(sum.curvature(step) / step.dot(dense * step), 1, 1e-9);
  }
}

}  // namespace
}  // namespace understudy::calibration

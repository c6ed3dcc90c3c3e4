// From the types of the public headers to the plain numbers of hexapod_lanes.h.
#pragma once

#include <cmath>

#include "kinematics/hexapod/hexapod.h"
#include "kinematics/hexapod/hexapod_newton.h"
#include "kinematics/rigid_pose.h"

namespace understudy::kinematics {

constexpr double kTurnMax = 0.6;    // [rad] per step; beyond it the linear model of a strut says little
constexpr double kTravelMax = 0.5;  // per step, of the mean strut length
constexpr double kBlockMin = 1e-4;  // near 1 in the workspace; below it J is better factored with pivots

inline simd::NewtonSettings newton_settings(const ForwardOptions& options) {
  return {options.tolerance, options.max_iterations, kTravelMax, kTurnMax, kRigidTolerance, kBlockMin};
}

inline simd::Hexapod plain_numbers(const HexapodGeometry& geometry) {
  simd::Hexapod g;
  double sum = 0;
  for (std::size_t i = 0; i < kStruts; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      g.base[k][i] = geometry.base_joint[i][static_cast<Eigen::Index>(k)];
      g.ball[k][i] = geometry.platform_joint[i][static_cast<Eigen::Index>(k)];
    }
    sum += g.ball[0][i] * g.ball[0][i] + g.ball[1][i] * g.ball[1][i];
  }
  g.deviation_squared = geometry.deviation * geometry.deviation;
  const double radius = std::sqrt(sum / kStruts);
  g.per_radius_cubed = 1 / (radius * radius * radius);
  return g;
}

inline simd::Platform<double> plain_numbers(const Pose& X_BT) {
  simd::Platform<double> X;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) X.R[k][j] = X_BT.matrix()(k, j);
    X.p[k] = X_BT.matrix()(k, 3);
  }
  return X;
}

inline Pose pose_of(const simd::Platform<double>& X) {
  Pose X_BT = Pose::Identity();
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) X_BT.matrix()(k, j) = X.R[k][j];
    X_BT.matrix()(k, 3) = X.p[k];
  }
  return X_BT;
}

}  // namespace understudy::kinematics

// axis_rates() against central differences of a mechanism's own inverse, started at the axes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinematics/mechanism.h"

namespace understudy::kinematics {

/// Largest difference between a rate and its central difference, relative to the largest rate (or 1). Steps
/// of 1e-5 m and rad leave h^2 times a third derivative (below 1e3) from truncation and 1e-12 / h from the
/// tolerance of a numeric inverse: 1e-7 in all.
inline double worst_rate_difference(const Mechanism& mechanism, const Pose& X, std::span<const double> axes) {
  constexpr double h = 1e-5;
  const int n = mechanism.axis_count();
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(n, 6);
  EXPECT_EQ(mechanism.axis_rates(X, axes, rates), SolveStatus::ok);
  double worst = 0;
  for (int column = 0; column < 6; ++column) {
    Twist twist = Twist::Zero();
    twist[column] = h;
    const auto moved = [&](double sign) {
      AxisVector found{};
      const Pose X_moved = make_pose(Mat3(exp_rotation(sign * twist.tail<3>()) * X.linear()),
                                     Vec3(X.translation() + sign * twist.head<3>()));
      EXPECT_EQ(mechanism.inverse(X_moved, axes, found), SolveStatus::ok);
      return found;
    };
    const auto ahead = moved(1), behind = moved(-1);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      worst = std::max(worst, std::abs(rates(i, column) - (ahead[k] - behind[k]) / (2 * h)));
    }
  }
  return worst / std::max(1.0, rates.cwiseAbs().maxCoeff());
}

}  // namespace understudy::kinematics

// The rigid motion that brings points onto measured ones (Umeyama 1991, as Eigen has it; Song 2015, section
// 4).
#pragma once

#include <array>
#include <optional>

#include "core/frames.h"

namespace understudy::vision {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

struct RigidFit {
  Pose X_WT = Pose::Identity();
  double residual_rms = 0;  ///< [m] of a point; three degrees of freedom of nine are left to it
};

/// Least squares of |p_W - X_WT p_T|; nothing when the points lie in a line (within 1e-6 of their extent) or
/// are not finite. Never a reflection.
std::optional<RigidFit> fit_rigid(const std::array<Vec3, 3>& p_T, const std::array<Vec3, 3>& p_W);

/// What shifts of the three measured points [m] do to the fitted pose, to the first order, in the order of
/// Twist: (translation of T's origin [m], rotation vector [rad]), both in the axes of W and at T's origin:
/// the shifted pose is (exp(rotation) R, p + translation).
Eigen::Matrix<double, 6, 9> fit_response(const Pose& X_WT, const std::array<Vec3, 3>& p_T);

/// Covariance of the fitted pose, in the same order, from the joint covariance of the three points.
/// Independent errors of sigma on an equilateral triangle of side a turn it by sqrt(2) sigma / a in its
/// plane's axes and sigma / a about its normal.
Mat6 fit_covariance(const Pose& X_WT, const std::array<Vec3, 3>& p_T, const Mat9& points);

}  // namespace understudy::vision

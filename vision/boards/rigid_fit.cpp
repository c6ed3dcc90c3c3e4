#include "vision/boards/rigid_fit.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/cross_matrix.h"

namespace understudy::vision {

namespace {

/// Area of the triangle relative to the square of its longest side; 0 where the points coincide.
bool in_line(const std::array<Vec3, 3>& p) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return !(a.cross(b).norm() > 1e-6 * longest);
}

Mat3 as_columns(const std::array<Vec3, 3>& p) {
  Mat3 columns;
  columns << p[0], p[1], p[2];
  return columns;
}

}  // namespace

std::optional<RigidFit> fit_rigid(const std::array<Vec3, 3>& p_T, const std::array<Vec3, 3>& p_W) {
  const Mat3 from = as_columns(p_T), to = as_columns(p_W);
  if (!from.allFinite() || !to.allFinite() || in_line(p_T) || in_line(p_W)) return std::nullopt;
  RigidFit fit{Pose(Eigen::umeyama(from, to, false)), 0};
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k) squares += (p_W[k] - fit.X_WT * p_T[k]).squaredNorm();
  fit.residual_rms = std::sqrt(squares / 3);
  return fit;
}

Eigen::Matrix<double, 6, 9> fit_response(const Pose& X_WT, const std::array<Vec3, 3>& p_T) {
  Eigen::Matrix<double, 9, 6> J;  // of the points over the pose
  for (int k = 0; k < 3; ++k) {
    const Vec3 arm = X_WT.linear() * p_T[static_cast<std::size_t>(k)];
    J.block<3, 3>(3 * k, 0).setIdentity();
    J.block<3, 3>(3 * k, 3) = -cross_matrix(arm);
  }
  return (J.transpose() * J).inverse() * J.transpose();
}

Mat6 fit_covariance(const Pose& X_WT, const std::array<Vec3, 3>& p_T, const Mat9& points) {
  const auto A = fit_response(X_WT, p_T);
  const Mat6 covariance = A * points * A.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace understudy::vision

#include "vision/boards/rigid_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace understudy::vision {

std::optional<RigidFit> fit_rigid(const std::array<Vec3, 3>& p_T, const std::array<Vec3, 3>& p_W) {
  const Vec3 middle_T = (p_T[0] + p_T[1] + p_T[2]) / 3, middle_W = (p_W[0] + p_W[1] + p_W[2]) / 3;
  Mat3 H = Mat3::Zero();
  for (std::size_t k = 0; k < 3; ++k) H += (p_W[k] - middle_W) * (p_T[k] - middle_T).transpose();
  if (!H.allFinite()) return std::nullopt;
  const Eigen::JacobiSVD<Mat3> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Singular values are squares of extents.
  if (!(svd.singularValues()[1] > 1e-12 * svd.singularValues()[0])) return std::nullopt;
  const Mat3& U = svd.matrixU();
  const Mat3& V = svd.matrixV();
  const double hand = U.determinant() * V.determinant() > 0 ? 1 : -1;
  const Mat3 R = U * Vec3(1, 1, hand).asDiagonal() * V.transpose();
  RigidFit fit{make_pose(R, Vec3(middle_W - R * middle_T)), 0};
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
    J.block<3, 3>(3 * k, 3) << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  }
  return (J.transpose() * J).inverse() * J.transpose();
}

Mat6 fit_covariance(const Pose& X_WT, const std::array<Vec3, 3>& p_T, const Mat9& points) {
  const auto A = fit_response(X_WT, p_T);
  const Mat6 covariance = A * points * A.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace understudy::vision

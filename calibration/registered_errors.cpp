#include "calibration/registered_errors.h"

#include <Eigen/Cholesky>

#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of all points over (translation, rotation vector about `middle`).
MatrixXd motion_rows(std::span<const Vec3> points, const Vec3& middle) {
  MatrixXd rows(3 * static_cast<Index>(points.size()), 6);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 r = points[k] - middle;
    const Index row = 3 * static_cast<Index>(k);
    rows.block<3, 3>(row, 0).setIdentity();
    rows.block<3, 3>(row, 3) = -cross_matrix(r);
  }
  return rows;
}

VectorXd stacked(std::span<const Vec3> errors) {
  VectorXd all(3 * static_cast<Index>(errors.size()));
  for (std::size_t k = 0; k < errors.size(); ++k) all.segment<3>(3 * static_cast<Index>(k)) = errors[k];
  return all;
}

}  // namespace

MatrixXd registration_of(std::span<const Vec3> registered, std::span<const Vec3> points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : registered) middle += p / static_cast<double>(registered.size());
  const MatrixXd A = motion_rows(registered, middle);
  return motion_rows(points, middle) * (A.transpose() * A).ldlt().solve(A.transpose());
}

std::vector<Vec3> registered_errors(const MatrixXd& M, std::span<const Vec3> at_registered,
                                    std::span<const Vec3> at_points) {
  const VectorXd left = stacked(at_points) - M * stacked(at_registered);
  std::vector<Vec3> errors;
  for (Index row = 0; row < left.size(); row += 3) errors.emplace_back(left.segment<3>(row));
  return errors;
}

std::vector<Mat3> registered_covariances(const MatrixXd& M, const ErrorModel& registered,
                                         const ErrorModel& points, const MatrixXd& covariance) {
  const MatrixXd rows = points.rows - M * registered.rows;
  std::vector<Mat3> covariances;
  for (std::size_t k = 0; k < points.own.size(); ++k) {
    const auto at = rows.middleRows<3>(3 * static_cast<Index>(k));
    Mat3 C = at * covariance * at.transpose() + points.own[k];
    for (std::size_t j = 0; j < registered.own.size(); ++j) {
      const auto by = M.block<3, 3>(3 * static_cast<Index>(k), 3 * static_cast<Index>(j));
      C += by * registered.own[j] * by.transpose();
    }
    covariances.push_back(C);
  }
  return covariances;
}

}  // namespace understudy::calibration

// Tip errors as they are left where the work was registered on the machine itself: a rigid motion of frame W
// moves the part with it, and what finds the part finds that motion, too. Errors that vary over the work
// space stay.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace understudy::calibration {

/// Errors at `points` that the rigid motion leaves which explains the errors at `registered` best (least
/// squares, small motion): of stacked errors e, e(points) - M e(registered). M has three rows for each of
/// `points`. At least three registered points that are not in one line.
Eigen::MatrixXd registration_of(std::span<const Vec3> registered, std::span<const Vec3> points);

/// e(points) - M e(registered), point by point.
std::vector<Vec3> registered_errors(const Eigen::MatrixXd& M, std::span<const Vec3> at_registered,
                                    std::span<const Vec3> at_points);

/// Covariance of the errors that are left, 3 x 3 at each point. `rows`: d (error) / d (numbers), three rows a
/// point, of numbers with `covariance`; `own`: what each point has besides, independent of all others.
struct ErrorModel {
  Eigen::MatrixXd rows;
  std::vector<Mat3> own;
};
std::vector<Mat3> registered_covariances(const Eigen::MatrixXd& M, const ErrorModel& registered,
                                         const ErrorModel& points, const Eigen::MatrixXd& covariance);

}  // namespace understudy::calibration

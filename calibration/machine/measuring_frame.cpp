#include "calibration/machine/measuring_frame.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "core/cross_matrix.h"

namespace understudy::calibration {
namespace {

constexpr double kLever = 30e-3;  // [m], of the targets: what a turn of them is worth beside a shift

constexpr int kMotion = 12;  // translation, rotation vector, symmetric strain (xx, yy, zz, yz, zx, xy)
using Motion = Eigen::Matrix<double, kMotion, 1>;
using Rows = Eigen::Matrix<double, 6, kMotion>;

/// What the frame's motion does to a measured pose; turns in metres of the lever.
Rows rows_of(const Vec3& r) {
  Rows rows = Rows::Zero();
  rows.block<3, 3>(0, 0).setIdentity();
  rows.block<3, 3>(0, 3) = -cross_matrix(r);
  rows.block<3, 6>(0, 6) << r.x(), 0, 0, 0, r.z(), r.y(), 0, r.y(), 0, r.z(), 0, r.x(), 0, 0, r.z(), r.y(),
      r.x(), 0;
  rows.block<3, 3>(3, 3) = kLever * Mat3::Identity();
  return rows;
}

Twist in_metres(Twist shift) {
  shift.tail<3>() *= kLever;
  return shift;
}

Vec3 middle_of(const std::vector<SharedError>& poses) {
  Vec3 middle = Vec3::Zero();
  for (const SharedError& pose : poses) middle += pose.tip / static_cast<double>(poses.size());
  return middle;
}

}  // namespace

Mat3 MeasuringFrame::covariance(const Vec3& from_middle) const {
  const Mat3 along = from_middle * from_middle.transpose();
  const Mat3 square = from_middle.squaredNorm() * Mat3::Identity();
  Mat3 strained = along;
  strained.diagonal() = square.diagonal();
  return position * position * Mat3::Identity() + rotation * rotation * (square - along) +
         strain * strain * strained;
}

MeasuringFrame measuring_frame(std::vector<SharedError>& poses) {
  if (poses.empty() || poses.front().shifts.empty()) return {};
  const Vec3 middle = middle_of(poses);
  Eigen::Matrix<double, kMotion, kMotion> normal = Eigen::Matrix<double, kMotion, kMotion>::Zero();
  for (const SharedError& pose : poses) {
    const Rows rows = rows_of(pose.tip - middle);
    normal += rows.transpose() * rows;
  }
  const auto solver = normal.ldlt();  // what few poses cannot tell is 0
  const std::size_t devices = poses.front().shifts.size();
  Motion squares = Motion::Zero();
  for (std::size_t r = 0; r < devices; ++r) {
    Motion right = Motion::Zero();
    for (const SharedError& pose : poses)
      right += rows_of(pose.tip - middle).transpose() * in_metres(pose.shifts[r]);
    const Motion motion = solver.solve(right);
    squares += motion.cwiseAbs2();
    for (SharedError& pose : poses) {
      Twist left = in_metres(pose.shifts[r]) - rows_of(pose.tip - middle) * motion;
      left.tail<3>() /= kLever;
      pose.left += left * left.transpose() / static_cast<double>(devices);
    }
  }
  squares /= static_cast<double>(devices);
  return {std::sqrt(squares.head<3>().mean()), std::sqrt(squares.segment<3>(3).mean()),
          std::sqrt(squares.tail<6>().mean())};
}

}  // namespace understudy::calibration

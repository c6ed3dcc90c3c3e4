#include "calibration/strut_model.h"

#include <Eigen/LU>
#include <cmath>

namespace understudy::calibration {

bool linearise(const HexapodParameters& machine, const PoseSample& sample, const Pose& X_BT,
               StrutLinearisation& at) {
  const HexapodGeometry& g = machine.geometry;
  const StrutLengths by_drive = strut_lengths(machine, sample);
  const Mat3 R = X_BT.linear();
  const Vec3 p = X_BT.translation();
  for (std::size_t i = 0; i < kStruts; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Vec3 a_B = R * g.platform_joint[i];
    const Vec3 d = g.base_joint[i] - p - a_B;
    const double squared = d.squaredNorm() - g.deviation * g.deviation;
    if (!(squared > 0)) return false;
    const double length = std::sqrt(squared);
    const Vec3 n = d / length;
    at.residual[k] = length - by_drive[i];
    at.by_geometry.block<3, 1>(0, k) = n;
    at.by_geometry.block<3, 1>(3, k) = -(R.transpose() * n);
    at.by_geometry(6, k) = -1;
    at.by_deviation[k] = -g.deviation / length;
    at.by_play[k] = 0.5 * static_cast<double>(sample.approach[i]);
    at.by_pose.block<1, 3>(k, 0) = -n.transpose();
    at.by_pose.block<1, 3>(k, 3) = n.cross(a_B).transpose();
  }
  return true;
}

ParameterRows<6> dense_rows(const StrutLinearisation& at, const Unknowns& unknowns) {
  ParameterRows<6> rows = ParameterRows<6>::Zero(6, unknowns.count());
  for (Eigen::Index i = 0; i < kStruts; ++i) {
    rows.block<1, kStrutParameters>(i, kStrutParameters * i) = at.by_geometry.col(i).transpose();
    if (unknowns.play) rows(i, unknowns.first_play() + i) = at.by_play[i];
  }
  if (unknowns.deviation) rows.col(kGeometryParameters) = at.by_deviation;
  return rows;
}

ParameterRows<6> pose_rows(const StrutLinearisation& at, const Unknowns& unknowns) {
  return -at.by_pose.partialPivLu().solve(dense_rows(at, unknowns));
}

}  // namespace understudy::calibration

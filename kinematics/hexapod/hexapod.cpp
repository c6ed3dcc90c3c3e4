#include "kinematics/hexapod/hexapod.h"

#include <cmath>
#include <limits>

#include "kinematics/hexapod/hexapod_numbers.h"

namespace understudy::kinematics {

SolveStatus inverse(const HexapodGeometry& geometry, const Pose& X_BT, StrutLengths& lengths) {
  simd::Struts<double> struts;
  simd::find_struts(plain_numbers(geometry), plain_numbers(X_BT), struts);
  bool all = true;
  for (const double s : struts.squared) all = all && s > 0 && s < std::numeric_limits<double>::infinity();
  // A number of the pose that is not finite is in every strut.
  if (!all) return X_BT.matrix().allFinite() ? SolveStatus::unreachable : SolveStatus::bad_input;
  for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = simd::root(struts.squared[i]);
  return SolveStatus::ok;
}

SolveStatus jacobian(const HexapodGeometry& geometry, const Pose& X_BT, Mat6& J) {
  StrutLengths lengths;
  const SolveStatus status = inverse(geometry, X_BT, lengths);
  if (status != SolveStatus::ok) return status;
  for (std::size_t i = 0; i < kStruts; ++i) {
    const Vec3 a_B = X_BT.linear() * geometry.platform_joint[i];
    // Not a unit vector when dev is not 0: the length is the leg of a right triangle with hypotenuse |d|.
    const Vec3 n = -(geometry.base_joint[i] - X_BT.translation() - a_B) / lengths[i];
    const Vec3 moment = a_B.cross(n);
    const auto row = static_cast<Eigen::Index>(i);
    J.block<1, 3>(row, 0) = n.transpose();
    J.block<1, 3>(row, 3) = moment.transpose();
  }
  return SolveStatus::ok;
}

double platform_radius(const HexapodGeometry& geometry) {
  double sum = 0;
  for (const Vec3& a : geometry.platform_joint) sum += a.head<2>().norm();
  return sum / kStruts;
}

HexapodJoints joints_at_home(const HexapodGeometry& geometry, const Pose& X_BT_home) {
  HexapodJoints joints;
  for (std::size_t i = 0; i < kStruts; ++i) {
    const Vec3& a = geometry.platform_joint[i];
    const Vec3& b = geometry.base_joint[i];
    const Vec3 u_T = (X_BT_home.linear().transpose() * (X_BT_home * a - b)).normalized();
    const Vec3 radial_T = Vec3(a.x(), a.y(), 0).normalized();
    joints.stud_axis[i] = (radial_T - radial_T.dot(u_T) * u_T).normalized();
    joints.radial_axis[i] = Vec3(b.x(), b.y(), 0).normalized();
  }
  return joints;
}

}  // namespace understudy::kinematics

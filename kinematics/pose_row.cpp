#include "kinematics/pose_row.h"

#include <algorithm>

#include "kinematics/quaternion_rotation.h"

namespace understudy::kinematics {

bool read_pose(const double* row, Pose& X) {
  double R[3][3];
  if (!simd::rotation(row[3], row[4], row[5], row[6], kUnitQuaternion, R)) return false;
  X = Pose::Identity();
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) X.matrix()(k, j) = R[k][j];
    X.matrix()(k, 3) = row[k];
  }
  return true;
}

void write_pose(const Pose& X, double* row) {
  Quat q(X.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Vec3 p = X.translation();
  std::copy_n(p.data(), 3, row);
  row[3] = q.w();
  std::copy_n(q.vec().data(), 3, row + 4);
}

}  // namespace understudy::kinematics

#include "core/frames.h"

#include <algorithm>
#include <cmath>

namespace understudy {

Pose make_pose(const Mat3& R, const Vec3& p) {
  Pose X = Pose::Identity();
  X.linear() = R;
  X.translation() = p;
  return X;
}

Pose make_pose(const Quat& q, const Vec3& p) { return make_pose(q.normalized().toRotationMatrix(), p); }

Vec3 log_rotation(const Mat3& R) {
  const Quat q(R);
  const Vec3 v = q.vec();
  const double n = v.norm();
  if (n < 1e-12) return (q.w() < 0 ? -2.0 : 2.0) * v;
  const double angle = 2 * std::atan2(n, std::abs(q.w()));
  return (q.w() < 0 ? -angle : angle) / n * v;
}

Mat3 exp_rotation(const Vec3& w) {
  const double angle = w.norm();
  if (angle < 1e-12) {
    Mat3 R;
    R << 1, -w.z(), w.y(), w.z(), 1, -w.x(), -w.y(), w.x(), 1;
    return R;
  }
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Pose interpolate(const Pose& from, const Pose& to, double t) {
  const Vec3 turn = log_rotation(from.linear().transpose() * to.linear());
  return make_pose(Mat3(from.linear() * exp_rotation(t * turn)),
                   from.translation() + t * (to.translation() - from.translation()));
}

double angle_between(const Mat3& a, const Mat3& b) { return log_rotation(a.transpose() * b).norm(); }

Quat shortest_arc_from_z(const Vec3& axis) {
  // Half-way vector; opposite to z any perpendicular axis serves, x is taken.
  if (axis.z() < -1 + 1e-12) return Quat(0, 1, 0, 0);
  return Quat(1 + axis.z(), -axis.y(), axis.x(), 0).normalized();
}

}  // namespace understudy

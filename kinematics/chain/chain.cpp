#include "kinematics/chain/chain.h"

#include <array>

#include "kinematics/chain/rods.h"

namespace understudy::kinematics {
namespace {

using LinkPoses = PerAxis<Pose>;

const Pose& carrier(const LinkPoses& poses, int axis, const Pose& frame) {
  return axis < 0 ? frame : poses[axis];
}

/// Of the tool, where `joint` is where the rods of a chain with rods meet.
Pose tool_at(const Chain& chain, const LinkPoses& poses, const Vec3& joint) {
  if (!chain.rods.empty()) return Eigen::Translation3d(joint) * chain.X_OT_zero;
  return carrier(poses, chain.tool_axis, Pose::Identity()) * chain.X_OT_zero;
}

Vec3 joint_of_rods(const Chain& chain, std::span<const double> axes) {
  Vec3 joint = Vec3::Zero();
  // Where they do not meet, a mechanism says so; here the nearest will do.
  if (!chain.rods.empty()) static_cast<void>(rods_meet(chain, axes, joint));
  return joint;
}

/// Velocity of the chain's axis, told at point p_O of what it carries.
void add_screw(const ChainAxis& axis, const Pose& X_OL, const Vec3& p_O, Vec3& v, Vec3& omega) {
  const Vec3 direction_O = X_OL.linear() * axis.direction;
  if (axis.angle) {
    omega = direction_O;
    v = direction_O.cross(p_O - X_OL * axis.point);
  } else {
    omega = Vec3::Zero();
    v = direction_O;
  }
}

}  // namespace

ChainAxis sliding_axis(const std::string& name, const Vec3& direction, int parent) {
  ChainAxis axis = turning_axis(name, direction, Vec3::Zero(), parent);
  axis.angle = false;
  return axis;
}

ChainAxis turning_axis(const std::string& name, const Vec3& direction, const Vec3& point, int parent) {
  ChainAxis axis;
  axis.name = name;
  axis.direction = direction;
  axis.point = point;
  axis.parent = parent;
  return axis;
}

Pose screw_motion(const ChainAxis& axis, double q) {
  Pose X = Pose::Identity();
  if (axis.angle) {
    X.linear() = Eigen::AngleAxisd(q, axis.direction).toRotationMatrix();
    X.translation() = axis.point - X.linear() * axis.point;
  } else {
    X.translation() = q * axis.direction;
  }
  return X;
}

void link_poses(const Chain& chain, std::span<const double> axes, std::span<Pose> poses) {
  for (std::size_t i = 0; i < chain.axes.size(); ++i) {
    const ChainAxis& axis = chain.axes[i];
    const Pose X = screw_motion(axis, axes[i]);
    poses[i] = axis.parent < 0 ? X : poses[axis.parent] * X;
  }
}

Pose forward(const Chain& chain, std::span<const double> axes) {
  LinkPoses poses;
  link_poses(chain, axes, poses);
  const Pose frame = Pose::Identity();
  const Pose X_OT = tool_at(chain, poses, joint_of_rods(chain, axes));
  if (chain.work_axis < 0) return chain.X_OS_zero.inverse() * X_OT;
  return (carrier(poses, chain.work_axis, frame) * chain.X_OS_zero).inverse() * X_OT;
}

Pose forward(const Chain& chain, std::span<const double> axes, ChainJacobian& jacobian) {
  LinkPoses poses;
  link_poses(chain, axes, poses);
  const Pose frame = Pose::Identity();
  const Vec3 joint = joint_of_rods(chain, axes);
  const Pose X_OT = tool_at(chain, poses, joint);
  const Pose X_OS = carrier(poses, chain.work_axis, frame) * chain.X_OS_zero;
  const Mat3 R_SO = X_OS.linear().transpose();
  jacobian.setZero(6, chain.size());
  if (!chain.rods.empty())
    jacobian.topRows<3>() = R_SO * rod_jacobian(chain, rod_vectors(chain, axes, joint));
  // What carries the tool moves it forwards, what carries the work moves it backwards; what carries both
  // moves nothing.
  const auto add_branch = [&](int last, double sign) {
    for (int i = last; i >= 0; i = chain.axes[i].parent) {
      Vec3 v, omega;
      add_screw(chain.axes[i], poses[i], X_OT.translation(), v, omega);
      jacobian.col(i).head<3>() += sign * (R_SO * v);
      jacobian.col(i).tail<3>() += sign * (R_SO * omega);
    }
  };
  add_branch(chain.tool_axis, 1);
  add_branch(chain.work_axis, -1);
  return X_OS.inverse() * X_OT;
}

}  // namespace understudy::kinematics

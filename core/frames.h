// Frames, poses and rotations. Everything is SI: metres, radians, seconds.
//
// Frames: W world (origin on the table top, z up), B machine base, P moving platform, T tool (origin is the
// nozzle tip, z from the part towards the machine), S workpiece, C camera (z forward, x right, y down),
// L laser (z along the beam). A pose X_AB maps coordinates in B to coordinates in A: p_A = X_AB * p_B.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace understudy {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Pose = Eigen::Isometry3d;
/// Linear part first, then angular: (v, omega).
using Twist = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Pose make_pose(const Quat& q, const Vec3& p);
Pose make_pose(const Mat3& R, const Vec3& p);

/// Rotation vector (axis times angle [rad], angle in [0, pi]) of a rotation, and its inverse.
Vec3 log_rotation(const Mat3& R);
Mat3 exp_rotation(const Vec3& w);

/// Position on the straight line, orientation on the shortest arc; t in [0, 1].
Pose interpolate(const Pose& from, const Pose& to, double t);

/// [rad], in [0, pi].
double angle_between(const Mat3& a, const Mat3& b);

/// The rotation that turns z into `axis` (a unit vector) by the shortest arc; no spin about the axis.
Quat shortest_arc_from_z(const Vec3& axis);

/// Tool axis of a pose: the third column, from the part towards the machine.
inline Vec3 tool_axis(const Pose& X_WT) { return X_WT.linear().col(2); }

}  // namespace understudy

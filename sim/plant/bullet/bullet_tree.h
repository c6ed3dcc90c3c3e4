// A tree of joints as Bullet wants it, from what is known about the bodies in one frame. Private to this
// room.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <memory>
#include <vector>

#include "core/frames.h"

#ifndef BT_USE_DOUBLE_PRECISION
#error "the plant needs Bullet in double precision: pkg-config bullet-float64"
#endif

namespace understudy::sim {

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion to_bullet(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat from_bullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// A body and the joint that holds it, expressed in the tree's frame F at the position where every joint
/// reads 0.
struct BulletLink {
  int parent = -1;  ///< -1: the frame
  bool angle = true;
  Vec3 axis_F = Vec3::UnitZ();    ///< unit
  Vec3 point_F = Vec3::Zero();    ///< [m], on a hinge's axis
  double mass = 0;                ///< [kg]
  Vec3 centre_F = Vec3::Zero();   ///< [m]
  Mat3 inertia_F = Mat3::Zero();  ///< [kg m^2], about the centre
};

/// Joints read 0; nothing damped, never asleep.
std::unique_ptr<btMultiBody> make_tree(const std::vector<BulletLink>& links, const Pose& X_WF);

/// A body that floats: centre of mass and principal moments along the axes of X_WC.
std::unique_ptr<btMultiBody> make_floating_body(double mass, const Vec3& moments, const Pose& X_WC);

/// Pose of a link's own frame, in its centre of mass along its principal axes; -1: the base.
Pose link_pose(const btMultiBody& tree, int link);

}  // namespace understudy::sim

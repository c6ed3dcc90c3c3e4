// One strut as a chain of joints: universal joint, screw offset from it by `dev`, ball joint.
#pragma once

#include "kinematics/hexapod/hexapod.h"

namespace understudy::sim {

/// A strut assembled at a pose, in W. The cross of the universal joint turns about `tangent`, fixed to the
/// base; the motor turns in the cross about `offset`, along which the screw's axis stands off by dev:
/// d = dev * offset + length * screw, so that |d|^2 = length^2 + dev^2 in every pose (Song 2015, eq 4).
struct StrutChain {
  Vec3 base_W;     ///< [m], centre of the universal joint
  Vec3 ball_W;     ///< [m], centre of the ball joint
  Vec3 tangent_W;  ///< unit, first axis of the universal joint
  Vec3 offset_W;   ///< unit, its second axis
  Vec3 screw_W;    ///< unit, along the screw from motor to ball
  double length;   ///< [m], strut length
};

/// Throws MachineError when the strut cannot be assembled: closer than dev, or along its own first axis.
StrutChain assemble_strut(const kinematics::HexapodGeometry& geometry,
                          const kinematics::HexapodJoints& joints, const Pose& X_WB, const Pose& X_WT,
                          int strut);

}  // namespace understudy::sim

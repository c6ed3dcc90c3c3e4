// The motor of a strut on its universal joint: how it swings with the ball joint, and what that costs.
#pragma once

#include "core/frames.h"

namespace understudy::sim {

/// A strut in the motor frame M of the MuJoCo plant (x along the offset, z along the screw, origin in the
/// universal joint), with everything expressed in M: d = (dev, 0, length).
struct StrutSwing {
  Mat3 R_BM;              ///< columns: offset, screw x offset, screw
  Vec3 tangent_M;         ///< first axis of the universal joint; (0, t_y, t_z)
  double length = 0;      ///< [m]
  double deviation = 0;   ///< [m]
  double per_length = 0;  ///< 1 / length
  double per_turn = 0;    ///< 1 / (t_y length): turn about the tangent for a velocity along the offset

  Vec3 screw_B() const { return R_BM.col(2); }
};

/// False where the strut lies along its first axis or is shorter than dev. `d_B`: from universal joint to
/// ball.
bool find_swing(const Vec3& d_B, const Vec3& tangent_B, double deviation, StrutSwing& swing);

/// A rigid body that swings with the motor, its centre on the offset, at dev.
struct SwingingBody {
  double mass = 0;    ///< [kg]
  double moment = 0;  ///< [kg m^2], about its centre, about any axis
};

/// Force [N] that its weight and inertia exert on the ball joint, in B; the screw's length is left to the
/// drive. `v_B`, `a_B`: velocity and acceleration of the ball joint.
Vec3 swing_force(const StrutSwing& swing, const SwingingBody& body, const Vec3& v_B, const Vec3& a_B,
                 const Vec3& gravity_B);

/// Its inertia as felt at the ball joint [kg], in B.
Mat3 swing_inertia(const StrutSwing& swing, const SwingingBody& body);

}  // namespace understudy::sim

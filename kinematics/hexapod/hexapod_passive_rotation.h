// Passive rotation of the lead screws: an effect of joints, switched on where nothing keeps a screw from
// turning in its nut. (Song 2015, section 2, has slide bushings on guide rails for that; without them it is
// there.)
//
// At the base a universal joint carries the motor with the nut; its outer axis is fixed to the base, along
// e_t = e_z x e_r (docs/reference.md#joint-angles, where alpha turns about it). At the platform the screw
// ends in a joint that turns about its stud, which is fixed to the platform, and tilts about an axis across
// stud and strut, but does not let the screw spin by itself. As the platform moves, the two joints turn the
// screw in the nut:
//   angle_i = angle about u from e_t x u to (R a_i) x u, less the same at home,
// with u the direction from base to ball joint and a_i the stud. Positive: the screw turns right-handed about
// u, seen from the motor. A right-handed thread (lead > 0) then drives the strut longer by lead / 2 pi a
// radian:
//   strut length = drive length + lead / 2 pi * angle,
// where the drive length is what the motor's turns make.
#pragma once

#include "kinematics/hexapod/hexapod.h"

namespace understudy::kinematics {

struct ScrewCoupling {
  double lead = 0;  ///< [m] per turn, right-handed positive; 0: guided screws, no effect at all
  HexapodJoints joints;
  PerStrut<double> angle_at_home{};  ///< [rad]
};

/// Joints in the middle of their range at home. `angle_at_home` is 0 where a joint is stretched out at home.
ScrewCoupling screw_coupling(const HexapodGeometry& geometry, const HexapodJoints& joints,
                             const Pose& X_BT_home, double lead);

/// Of the screw in the nut, less that at home, in (-pi, pi]: a continuous reading as long as joints swing by
/// less than half a turn. [rad] Strut numbers from 0. `singular`: the strut lies along the outer axis at its
/// base or along its stud, where a universal joint passes on no turn; `bad_input`: a pose that is not finite;
/// the angle is then 0.
SolveStatus passive_rotation(const HexapodGeometry& geometry, const ScrewCoupling& coupling, const Pose& X_BT,
                             int strut, double& angle);

// The kinematics of drive lengths. With lead 0 they are those of strut lengths, to the bit.

/// Drive lengths for a pose; besides the reasons of the plain inverse, `singular` as above.
SolveStatus inverse(const HexapodGeometry& geometry, const ScrewCoupling& coupling, const Pose& X_BT,
                    StrutLengths& drive_lengths);
/// Fixed point over the plain forward kinematics, whose branch rule it keeps: each round corrects the strut
/// lengths by the rotation at the last pose. A round leaves lead / 2 pi times the rotation per strut travel
/// of the error, some 1 % on a desktop machine. Iterations count the plain ones; the residual is of drive
/// lengths.
ForwardResult forward(const HexapodGeometry& geometry, const ScrewCoupling& coupling,
                      const StrutLengths& drive_lengths, const Pose& seed,
                      const ForwardOptions& options = {});

/// A hexapod whose axes are drive lengths: what a controller that knows of the coupling works with.
std::unique_ptr<Mechanism> make_hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints,
                                        const HexapodLimits& limits, const Pose& X_BT_home,
                                        const ScrewCoupling& coupling);

}  // namespace understudy::kinematics

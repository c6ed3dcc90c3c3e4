// On which side the play of each strut rests, by what the controller knows: the description's masses and its
// own geometry. A table of measured poses says so in a1 to a6.
#pragma once

#include "calibration/problem.h"
#include "machine/description.h"

namespace understudy::calibration {

/// [N] that each drive pushes (positive) or pulls along its strut to hold the platform still: virtual work of
/// the weights of platform, nuts and motors. False where the pose is singular or out of reach.
bool strut_loads(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                 const Pose& X_BT, StrutLengths& load);

/// 1 sigma of these loads on a machine whose geometry is off by `tolerances`, to first order. False where
/// strut_loads() is.
bool load_sigmas(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                 const machine::ToleranceSet& tolerances, const Pose& X_BT, StrutLengths& sigma);

/// Where each play most probably rests: 1 as if the strut had come by lengthening (it pushes), -1 as by
/// shortening (it pulls), between them where the nut's own weight keeps one play on either side.
kinematics::PerStrut<double> probable_sides(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_BT);

/// Mean square of how far each side is from the probable one: the load is normally distributed by
/// load_sigmas() and 0.1 N (three sigma), and friction holds a side evenly anywhere within. 0 where the side
/// is sure, 2 where a strut without a nut's weight is as likely to push as to pull. False where strut_loads()
/// is.
bool side_variances(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                    const machine::ToleranceSet& tolerances, const Pose& X_BT,
                    kinematics::PerStrut<double>& variance);

/// A strut that pushes rests as if it had come by lengthening, one that pulls as by shortening. `unknown`
/// within friction of the joints, between the sides (where the nut's own weight keeps one play on either),
/// and nearer to that than three sigma of the load, for a geometry that is off by `tolerances`, and 0.1 N.
kinematics::PerStrut<Approach> resting_sides(const machine::MachineDescription& machine,
                                             const kinematics::HexapodGeometry& geometry,
                                             const machine::ToleranceSet& tolerances, const Pose& X_BT);

/// Sides that are unknown become those that the loads on a calibrated `geometry` tell; others stay. The
/// number of those that were unknown and are known now.
int note_sides(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
               const Pose& X_BT, kinematics::PerStrut<Approach>& sides);

}  // namespace understudy::calibration

// Forward kinematics where nothing is known of the pose: after a power cut, or with a wrong guess.
#pragma once

#include "kinematics/hexapod/hexapod.h"

namespace understudy::kinematics {

/// Six lengths have up to 40 assemblies; a machine leaves the one it was put together in only through a
/// singularity. So the answer must lie on home's side: its det J has the sign of home's. Tried in turn until
/// one does: Newton from `seed`, from `home`, and from home by short moves of the lengths. The seed may be
/// 100 mm and 30 degrees off, or anything; a better one only saves time. Near seeds belong to forward(),
/// which keeps to the seed's own side.
///
/// The status is that of the last attempt. `singular` also where no attempt ended on home's side.
ForwardResult forward_global(const HexapodGeometry& geometry, const StrutLengths& lengths, const Pose& seed,
                             const Pose& X_BT_home, const ForwardOptions& options = {});

}  // namespace understudy::kinematics

// A calibrated hexapod as a controller drives by it: what it commands for a pose, and what it states of the
// tip's error there.
#pragma once

#include <span>

#include "calibration/bundle/bundle_adjustment.h"
#include "calibration/registered_errors.h"
#include "machine/description.h"

namespace understudy::studies {

struct DrivenModel {
  calibration::HexapodParameters parameters;
  kinematics::PerStrut<double> lead{};  ///< relative, as calibration::BundleState
  /// Commands allow for the play, on the side where the struts' loads have it.
  bool allows_for_play = false;

  /// [m], of the drives; false where the pose is out of reach.
  bool displacements(const machine::MachineDescription& machine, const Pose& X_BT,
                     kinematics::StrutLengths& displacement) const;
};

/// d (tip error) / d (machine, leads, warming) at these poses, three rows each, in B; the warming counts from
/// its end on, and is 0. Each strut's length has the noise of problem.drives besides, independent of all
/// others: more where the side of its play is not known.
calibration::ErrorModel tip_errors_of(const calibration::BundleProblem& problem, const DrivenModel& model,
                                      const machine::MachineDescription& machine, std::span<const Pose> X_BT);

}  // namespace understudy::studies

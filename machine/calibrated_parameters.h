// What a calibration found besides the geometry that the controller uses: how well its parameters are known,
// and the play. A controller needs neither, so they stand in the machine file and not in the description.
#pragma once

#include <optional>
#include <string>

#include "machine/description.h"

namespace understudy::machine {

/// Of a machine whose file has no section `calibration`: neither.
struct CalibratedParameters {
  /// [m], total free travel along each strut of a hexapod, where the estimator found it.
  std::optional<kinematics::PerStrut<double>> play;
  /// Of the errors of the section's numbers; symmetric, positive semi-definite, 0 where a number was not
  /// estimated. [m] and [rad], directions count as [rad]. Empty: not known, of a plug-in's calibration.
  ///
  /// Order, of a hexapod: base joint in B, platform joint in T and length offset of strut 1, 2, ...; dev; the
  /// play of struts 1 to 6 where there is `play`, then their `lead` where there is that. Of a chain: position
  /// and rotation vector, both in O, of the tool, then of the work; then of each axis its direction and, of a
  /// turn, its point.
  Eigen::MatrixXd covariance;
  /// Share of its travel by which each strut of a hexapod goes farther than its motor's turns say, where it
  /// was identified (docs/identify.md).
  std::optional<kinematics::PerStrut<double>> lead = {};
};

/// What one row of the covariance is multiplied by to come from the file's unit to SI; one for each row.
Eigen::VectorXd calibrated_units(const MachineDescription& machine, bool with_play, bool with_lead = false);

/// As load_machine(), with what the file says of the calibration's parameters.
MachineDescription load_machine(const std::string& name_or_path, CalibratedParameters& parameters);

}  // namespace understudy::machine

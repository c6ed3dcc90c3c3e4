// Where a hexapod's tool is for given drive displacements, before any engine has moved it.
#pragma once

#include "machine/port.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// How the joints turn the screws of the machine that stands there: as it was drawn, whatever a calibration
/// believes of it; lead 0 where rails guide them.
kinematics::ScrewCoupling built_screw_coupling(const machine::MachineDescription& machine);

/// What the screws' turning adds to the struts as the joints swing; nothing where rails guide them.
class ScrewTurning {
 public:
  ScrewTurning(const machine::MachineDescription& machine, const AsBuilt& as_built);
  /// [m], of the strut at a pose of the tool. Throws MachineError where a joint is stretched out.
  double growth(const Pose& X_WT, int strut) const;
  const kinematics::ScrewCoupling& coupling() const { return coupling_; }

 private:
  kinematics::HexapodGeometry geometry_;
  kinematics::ScrewCoupling coupling_;
  Pose X_BW_;
};

/// X_WT on the branch of home. Throws MachineError, with the strut lengths, when the loops cannot be closed.
Pose assemble_hexapod(const machine::MachineDescription& machine, const AsBuilt& as_built,
                      const kinematics::AxisVector& displacement);

/// Drive displacements at home. Throws MachineError when the as-built machine does not reach it.
kinematics::AxisVector home_displacement(const machine::MachineDescription& machine, const AsBuilt& as_built);

/// That a built hexapod can stand with its drives where the description has them at home, as a machine does
/// whose drives are referenced; any other machine can. Throws InputError, said of the as-built file or of the
/// machine's.
void check_stands_at_home(const machine::MachineDescription& machine, const AsBuilt& as_built);

}  // namespace understudy::sim

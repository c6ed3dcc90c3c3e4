// Encoders on what the axes carry, behind the play: strut scales, rings at joints.
#pragma once

#include "kinematics/chain/chain.h"
#include "machine/description.h"
#include "machine/load_encoders.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// Where the true axes are, by the true pose of the tool: zeros, screws and plays of the built machine are in
/// it. The encoders themselves are without error but for their counts. Does not allocate or throw.
class LoadEncoders {
 public:
  LoadEncoders(const machine::MachineDescription& machine, const AsBuilt& as_built,
               const machine::LoadEncoderCounts& counts);

  /// Every axis has one.
  bool present() const { return present_; }
  /// Positions in whole counts, `near`: axis positions by the drives. False where no positions make the pose.
  bool read(const Pose& X_WT, const kinematics::AxisVector& near, kinematics::AxisVector& positions) const;

 private:
  bool chain_positions(const Pose& X_BT, kinematics::AxisVector& positions) const;

  bool hexapod_;
  bool present_ = true;
  int axes_ = 0;
  Pose X_BW_;
  kinematics::HexapodGeometry struts_;
  kinematics::ScrewCoupling coupling_;  ///< that the controller knows of
  kinematics::Chain chain_;
  kinematics::AxisVector count_{};  ///< [m] or [rad]
};

}  // namespace understudy::sim

// What a calibration's covariance means at the tip, over the work space.
#pragma once

#include <functional>

#include "calibration/machine/calibrate.h"

namespace understudy::rehearsal {

/// Covariance of the tip [m^2] at a pose that the calibrated machine is driven to; false where it cannot go.
using TipCovariance = std::function<bool(const Pose& X_BT, Mat3& covariance)>;

/// `before` knows the machine as it was known, `after` as it is known now.
TipMap tip_map(const machine::MachineDescription& before, const machine::MachineDescription& after,
               const TipCovariance& covariance);

TipCovariance hexapod_tip(const machine::MachineDescription& machine,
                          const calibration::Calibration& calibration, const calibration::Unknowns& unknowns);
TipCovariance chain_tip(const machine::MachineDescription& machine,
                        const calibration::ChainCalibration& calibration);

/// With the share of the frame in which the tips were measured.
TipCovariance in_frame(const TipCovariance& covariance, const Measurements& measurements, const Pose& X_WB);

/// The same machine with all zeros 0: screws and mounts moved to where the axes read 0.
kinematics::Chain zeros_absorbed(const calibration::ChainParameters& machine);

}  // namespace understudy::rehearsal

#pragma once

#include "calibration/estimators/chain_calibration.h"

namespace understudy::calibration {

/// The same machine with all zeros 0: screws and mounts moved to where the axes read 0.
kinematics::Chain absorb_zeros(const ChainParameters& machine);

}  // namespace understudy::calibration

#pragma once

#include "calibration/machine/calibrate.h"

namespace understudy::rehearsal {

/// The open chain's half of calibrate(): axes, tool and measuring frame by maximum_likelihood or robust.
void calibrate_chain_machine(const Measurements& measurements, const machine::MachineDescription& nominal,
                             CalibrateResult& result);

}  // namespace understudy::rehearsal

// Built machines as a calibration leaves it open: all that its covariance allows.
#pragma once

#include <cstdint>

#include "machine/calibrated_parameters.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

/// The calibrated geometry of `machine`, moved by errors drawn from the covariance; seed and `source` name
/// the random stream. Where the estimator found the play of each strut, it is drawn too and shared out
/// between nut and ball joints as the description has it. The covariance must have the machine's rows.
AsBuilt draw_calibrated(const machine::MachineDescription& machine,
                        const machine::CalibratedParameters& parameters, std::uint64_t seed);

/// The same for the file that `machine` was read from, with what the calibration does not tell drawn within
/// the tolerances of the file and of `fixture`: drives, sensors, part and filament, and play unless it was
/// found. Throws
/// InputError, with what to do, where it has no calibration or its calibration no covariance.
AsBuilt draw_calibrated(const machine::MachineDescription& machine, const TruthSeeds& seeds,
                        const std::string& fixture = {});

}  // namespace understudy::sim

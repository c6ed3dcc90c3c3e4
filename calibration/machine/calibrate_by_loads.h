// The sides on which plays rest, by the loads on the machine that measured poses show, as
// calibration/bundle/sides_by_loads.h has them for pictures.
#pragma once

#include "calibration/estimators/estimator.h"
#include "machine/description.h"

namespace understudy::calibration {

/// As estimator.calibrate(). Where it finds plays, and the loads on the machine found tell a side that was
/// unknown, that is noted in `problem`, and the estimator calibrates again. Sides that were told stay.
Calibration calibrate_by_loads(const machine::MachineDescription& machine, const Estimator& estimator,
                               Problem& problem, const Options& options = {});

}  // namespace understudy::calibration

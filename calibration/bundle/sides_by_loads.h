// The sides on which plays rest, by the loads on the machine that the pictures show: before a calibration
// the geometry, and with it a load near 0, is not known well enough.
#pragma once

#include "calibration/bundle/bundle_adjustment.h"
#include "machine/description.h"

namespace understudy::calibration {

/// As adjust_bundle(). Where plays are unknown and the loads on the machine found tell a side that was
/// unknown, it is noted in `problem`, and all is adjusted again. Sides that were told stay.
BundleAdjustment adjust_bundle_by_loads(const machine::MachineDescription& machine, BundleProblem& problem);

}  // namespace understudy::calibration

// The `faults` of a scenario file.
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "rehearsal/fault_request.h"

namespace understudy::regression {

/// The list under `faults`. Throws InputError with file and line.
std::vector<rehearsal::FaultRequest> read_faults(rehearsal::StrictMap& scenario);

}  // namespace understudy::regression

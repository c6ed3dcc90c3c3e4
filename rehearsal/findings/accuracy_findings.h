// A print that is not where it should be.
#pragma once

#include <vector>

#include "machine/accepted_errors.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/observers/trace_observer.h"

namespace understudy::rehearsal {

/// Errors for the tip and the tool's orientation where the largest true error while extruding exceeds the
/// accepted one.
std::vector<Finding> accuracy_findings(const ErrorPeak& tip, const ErrorPeak& orientation,
                                       const machine::AcceptedErrors& accepted);

}  // namespace understudy::rehearsal

// From what observers saw to findings in the words and units of the contract.
#pragma once

#include <vector>

#include "control/motion/constraint_check.h"
#include "rehearsal/record.h"
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

std::vector<Finding> findings_of(const control::ConstraintReport& report);
std::vector<Finding> findings_of(const TwinRun& run, const TwinSetup& setup, control::GapControl gap_control);

/// Errors first, then by line and time.
void sort_findings(std::vector<Finding>& findings);

}  // namespace understudy::rehearsal

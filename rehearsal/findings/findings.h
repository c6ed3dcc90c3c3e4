// From what observers saw to findings in the words and units of the contract.
#pragma once

#include <vector>

#include "control/motion/constraint_check.h"
#include "rehearsal/record.h"
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

std::vector<Finding> findings_of(const control::ConstraintReport& report);
std::vector<Finding> findings_of(const TwinRun& run, const TwinSetup& setup, control::GapControl gap_control);

/// To findings of limits, of a program that is simulated in spite of them: how.
void tell_how_simulated(std::vector<Finding>& findings);

/// Errors first, then by line and time.
void sort_findings(std::vector<Finding>& findings);

}  // namespace understudy::rehearsal

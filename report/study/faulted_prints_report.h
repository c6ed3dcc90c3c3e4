// Prints under faults as faults.json, runs.csv and lines for a terminal.
#pragma once

#include <string>

#include "studies/faults/faulted_prints.h"

namespace understudy::report {

/// A line for each fault, then each go on a spoilt part with the command that repeats it.
std::string faulted_prints_table(const studies::FaultedPrints& prints);
std::string faulted_prints_json(const studies::FaultedPrints& prints);
std::string faulted_prints_csv(const studies::FaultedPrints& prints);  ///< a line for each run

}  // namespace understudy::report

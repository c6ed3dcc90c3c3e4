// A repeatability study as a file and for a terminal.
#pragma once

#include <string>

#include "studies/repeatability/repeatability.h"

namespace understudy::report {

/// repeatability.json: mean, largest and each pose, in um.
std::string repeatability_json(const studies::Repeatability& study);
std::string repeatability_table(const studies::Repeatability& study);

}  // namespace understudy::report

// The study of compensated prints as a table, and as JSON (docs/compensation.md).
#pragma once

#include <string>

#include "studies/compensation/compensated_prints.h"

namespace understudy::report {

std::string compensation_table(const studies::CompensationStudy& study);
/// Schema understudy.compensation/1.
std::string compensation_json(const studies::CompensationStudy& study);

}  // namespace understudy::report

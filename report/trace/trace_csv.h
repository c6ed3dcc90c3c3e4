// trace.csv of a rehearsal.
#pragma once

#include <string>

#include "rehearsal/record.h"

namespace understudy::report {

/// One row a trace point, after a header that names the units. The gap's cell is empty where nothing lies
/// below.
std::string trace_csv(const rehearsal::Record& record);

}  // namespace understudy::report

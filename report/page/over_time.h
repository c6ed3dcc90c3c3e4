// The curves of loads, temperatures and clearance in the data block (docs/report-data.md#over-time).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::report {

/// Null where the record has none of them.
nlohmann::ordered_json over_time(const rehearsal::Record& record);

}  // namespace understudy::report

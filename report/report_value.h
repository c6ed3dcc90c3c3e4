// The report's data block, "understudy.report/1" (docs/report-data.md): what a viewer draws from.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

nlohmann::ordered_json report_value(const Record& record);

}  // namespace understudy::rehearsal

// The report's data block, "understudy.report/1" (docs/report-data.md): what a viewer draws from.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

/// Without its pictures.
nlohmann::ordered_json report_data(const rehearsal::Record& record);
/// Its "pictures".
nlohmann::ordered_json pictures_value(const std::vector<Illustration>& pictures);

}  // namespace understudy::report

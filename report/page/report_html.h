// report.html of a rehearsal.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
std::string report_html(const rehearsal::Record& record, const std::vector<Illustration>& pictures);
/// The same of data that were made before (report_data()).
std::string report_page(const rehearsal::Record& record, const nlohmann::ordered_json& data);

/// The same page of a rehearsal that still runs, drawn from `json` (LiveRecord::json()). It asks its server
/// for what comes.
std::string live_html(const std::string& title, const std::string& json);

}  // namespace understudy::report

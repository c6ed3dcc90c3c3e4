// report.html of a rehearsal.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::report {

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
/// `data`: report_data() of the record, with its pictures.
std::string report_html(const rehearsal::Record& record, const nlohmann::ordered_json& data);

/// The same page of a rehearsal that still runs, drawn from `json` (LiveRecord::json()). It asks its server
/// for what comes.
std::string live_html(const std::string& title, const std::string& json);

}  // namespace understudy::report

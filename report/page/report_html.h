// report.html of a rehearsal.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
std::string report_html(const rehearsal::Record& record, const std::vector<Illustration>& pictures);

/// The same page of a rehearsal that still runs, drawn from `json` (LiveRecord::json()). It asks its server
/// for what comes.
std::string live_html(const std::string& title, const std::string& json);

}  // namespace understudy::report

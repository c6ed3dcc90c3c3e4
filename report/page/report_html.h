// report.html of a rehearsal.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
std::string report_html(const rehearsal::Record& record, const std::vector<Illustration>& pictures);

}  // namespace understudy::report

// What identifying a machine from a port record prints, and its summary.json.
#pragma once

#include <string>

#include "calibration/identify/identify.h"

namespace understudy::report {

std::string identify_text(const calibration::Identification& found);
/// Schema "understudy.identify/1".
std::string identify_json(const calibration::Identification& found);

}  // namespace understudy::report

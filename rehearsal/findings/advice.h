// What a user can do about a finding.
#pragma once

#include <string>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// One line; commands and options stand between backquotes and fit the run of the record. Empty where there
/// is nothing to do.
std::string advice(const Finding& finding, const Record& record);

/// The tip is off by as much as a contact is deep: one that is off by less is not all of its cause.
bool tip_error_explains(const Record& record, double depth_mm);

}  // namespace understudy::rehearsal

// The page of a record that was replayed on the twin: the answer, a table, and the differences over time.
#pragma once

#include <string>

#include "rehearsal/replayed_record.h"

namespace understudy::report {

std::string replay_html(const rehearsal::ReplayedRecord& replay);

}  // namespace understudy::report

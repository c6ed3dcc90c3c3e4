// The page of `understudy compare`.
#pragma once

#include <string>

#include "report/recorded/rehearsal_comparison.h"

namespace understudy::report {

/// One self-contained page: the answer, what differs, and both runs' curves over each other.
std::string comparison_html(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b);

}  // namespace understudy::report

// compare.json, the answer of `understudy compare`.
#pragma once

#include <string>

#include "report/recorded/rehearsal_comparison.h"

namespace understudy::report {

/// "understudy.comparison/1" (docs/comparing.md). Keys whose value does not exist are left out; equal folders
/// give equal bytes.
std::string comparison_json(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b);

}  // namespace understudy::report

// Two rehearsals beside each other as tables, for a terminal and for a page.
#pragma once

#include <string>
#include <vector>

#include "report/page/word_table.h"
#include "report/recorded/rehearsal_comparison.h"

namespace understudy::report {

/// Inputs, findings and figures that differ; a table without rows is left out.
std::vector<WordTable> comparison_tables(const RehearsalComparison& comparison);

/// "GO", or "GO -> NO-GO" where the two differ; `arrow` stands between.
std::string verdict_change(const RecordedRehearsal& a, const RecordedRehearsal& b, const char* arrow);

/// All of it for a terminal: plain lines, whatever characters the names in the records have.
std::string comparison_text(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b);

}  // namespace understudy::report

// Writes a record as files: summary.json (the contract), trace.csv, frames/*.png, report.html.
#pragma once

#include <filesystem>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// The contract's summary; keys whose value is absent are left out. Non-finite numbers never appear.
std::string summary_json(const Record& record);
std::string trace_csv(const Record& record);

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
std::string report_html(const Record& record);

/// All of them into an existing folder.
void write_results(const Record& record, const std::filesystem::path& folder);

}  // namespace understudy::rehearsal

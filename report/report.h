// Writes a record as files: summary.json (the contract), trace.csv, frames/*.png, report.html.
#pragma once

#include <filesystem>
#include <string>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// One sentence for people: why it is a go, or what stands against it.
std::string verdict_sentence(const Record& record);

/// The contract's summary; keys whose value is absent are left out. A number that is not finite is our own
/// mistake and throws std::logic_error. Numbers carry six significant digits; equal records give equal bytes.
std::string summary_json(const Record& record);

/// One row a trace point, after a header that names the units. The gap's cell is empty where nothing lies
/// below.
std::string trace_csv(const Record& record);

/// One page that opens from disk without a network: verdict first, then findings, pictures and charts.
std::string report_html(const Record& record);

/// All of them into an existing folder: summary.json, report.html, and where the record has them trace.csv,
/// frames/approach-NN.png with frames/approach.csv, pictures/picture-NN.png.
void write_results(const Record& record, const std::filesystem::path& folder);

}  // namespace understudy::rehearsal

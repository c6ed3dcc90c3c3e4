// A rehearsal's folder of results.
#pragma once

#include <filesystem>
#include <vector>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

/// Into an existing folder: summary.json, report.html, and where the record has them timing.json,
/// as-built.yaml, trace.csv, frames/approach-NN.png with frames/approach.csv; pictures/picture-NN.png.
void write_results(const rehearsal::Record& record, const std::vector<Illustration>& pictures,
                   const std::filesystem::path& folder);

}  // namespace understudy::report

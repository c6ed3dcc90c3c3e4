// A rehearsal's folder of results.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

using DrawPictures = std::function<std::vector<Illustration>()>;

/// Of its scene; nothing where it has none. The record must outlive it.
DrawPictures pictures_of(const rehearsal::Record& record);

/// Into an existing folder: summary.json, report.html, and where the record has them timing.json,
/// as-built.yaml, trace.csv, frames/approach-NN.png with frames/approach.csv; pictures/picture-NN.png.
/// Pictures are drawn while the rest is written, on another thread where there may be one.
void write_results(const rehearsal::Record& record, const DrawPictures& draw,
                   const std::filesystem::path& folder);

}  // namespace understudy::report

// trace.csv of a rehearsal, read back.
#pragma once

#include <filesystem>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::report {

/// Of each point what curves are drawn from: time, line, extruding, errors, gap and path; poses and axes stay
/// at their defaults. Throws InputError with file, line and column where the file cannot be read, was cut
/// off, lacks one of these columns, has a cell that is no finite number (an empty gap: nothing lies below),
/// or goes back in time.
std::vector<rehearsal::TracePoint> read_recorded_trace(const std::filesystem::path& file);

}  // namespace understudy::report

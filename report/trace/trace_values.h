// Trace points in the units of files, shared by trace.csv and the report's data block.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::report {

/// Column names in order: time_s, line, extruding, true pose, programmed pose, errors, gap, path, axes.
std::vector<std::string> trace_columns(const rehearsal::Record& record);

/// Values of one row in that order. The gap is infinite where nothing lies below the tip; anything else that
/// is not finite throws std::logic_error naming the column.
void trace_row(const rehearsal::TracePoint& point, const rehearsal::Record& record,
               const std::vector<std::string>& columns, std::vector<double>& row);

/// Decimals that keep a tenth of what the quantity's instrument could resolve, by the unit in the name.
int column_decimals(const std::string& name);

/// At most about `points_max` indices, increasing. Extremes of gap and tip error, both ends and every point
/// where extrusion starts or stops are kept, so that a chart of them hides nothing.
std::vector<std::size_t> thin_out(const std::vector<rehearsal::TracePoint>& trace, std::size_t points_max);

}  // namespace understudy::report

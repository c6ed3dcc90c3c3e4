// trace.csv of a rehearsal.
#pragma once

#include <string>

#include "core/file/staged_file.h"
#include "rehearsal/record.h"

namespace understudy::report {

/// One row a trace point, after a header that names the units. The gap's cell is empty where nothing lies
/// below.
std::string trace_csv(const rehearsal::Record& record);
/// The same in pieces of a hundred kilobytes or so.
void make_trace_csv(const rehearsal::Record& record, const AppendPiece& append);

}  // namespace understudy::report

// The trace of a rehearsal by columns, as HDF5.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace understudy::report {

/// Columns of one length; the unit of a column is the end of its name, as in trace.csv. NaN: an empty cell.
struct TraceTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// Reads trace.csv (trace_csv.h); `name` stands in errors. Throws InputError with line and column for a table
/// that is none, for one without rows, and for rows of another length.
TraceTable read_trace_csv(const std::string& text, const std::string& name);

/// The bytes of a file with one dataset a column in the group "trace", each with the attribute "unit", packed
/// in chunks; `line` is int32 and `extruding` uint8. `attributes` are texts of the file itself. Equal tables
/// give equal bytes. Throws MachineError where the library fails.
std::string trace_hdf5(const TraceTable& table,
                       const std::vector<std::pair<std::string, std::string>>& attributes);

}  // namespace understudy::report

// The trace of a rehearsal by columns, as HDF5.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/recorded/trace_table.h"

namespace understudy::report {

/// The bytes of a file with one dataset a column in the group "trace", each with the attribute "unit", packed
/// in chunks; `line` is int32 and `extruding` uint8. `attributes` are texts of the file itself. Equal tables
/// give equal bytes. Throws MachineError where the library fails.
std::string trace_hdf5(const TraceTable& table,
                       const std::vector<std::pair<std::string, std::string>>& attributes);

/// Of the HDF5 library, as it is loaded: "1.10.8".
std::string loaded_hdf5();

}  // namespace understudy::report

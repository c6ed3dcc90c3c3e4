// From tables and the map of their columns to rows of measurements, units recognised or checked by the
// machine.
#pragma once

#include <string>
#include <vector>

#include "calibration/table/column_map.h"
#include "machine/description.h"

namespace understudy::calibration {

struct MeasuredRows {
  RowProblem problem;
  std::vector<std::string> files;  ///< by MeasurementRow::table
  std::string sha256;              ///< of the bytes of all of them, in their order
  std::vector<std::string> notes;  ///< what was recognised
};

/// `files` are read by the map's one table; where it has none of them, its tables name their own. Throws
/// InputError with file and line for what cannot be read, for axes beyond their ranges, and for units and
/// conventions with which no place of the measuring frame fits. What rows are of is named by their file,
/// with its folder where another one of `files` and `beside` has the same name.
MeasuredRows read_measured_rows(const ColumnMap& map, const std::vector<std::string>& files,
                                const machine::MachineDescription& machine,
                                const std::vector<std::string>& beside = {});

}  // namespace understudy::calibration

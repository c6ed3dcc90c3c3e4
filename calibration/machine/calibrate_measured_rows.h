// From tables of any kind of measurement, read by a map of their columns, to a calibrated machine
// (docs/measurements.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/machine/machine_calibration.h"
#include "calibration/table/column_map.h"
#include "core/progress.h"

namespace understudy::calibration {

struct RowsRequest {
  ColumnMap map;
  std::vector<std::string> measurements;  ///< paths; none where the map names its files
  std::vector<std::string> compared;      ///< paths of rows that are not fitted (compared_tables.h)
  std::string machine;                    ///< name or path
  std::optional<MeasurementNoise> noise;  ///< of rows that tell none
  DrawingPrior prior = {};
  std::string command;  ///< for the record
  Progress progress = {};
};

/// Throws InputError, with file and line where one row is at fault, for all that
/// read_measured_rows() refuses, for rows that do not tell what they are to tell, and for rows that no
/// calibration of this machine explains.
MachineCalibration calibrate_measured_rows(const RowsRequest& request);

/// The map of a table with our own column names (docs/calibration-data.md) that has positions without
/// orientations, or orientations without positions, in W; nothing for any other table. `text` is that of the
/// file, which is not read again.
std::optional<ColumnMap> map_of_partial_poses(const std::string& text, const std::string& file,
                                              const std::string& machine);

}  // namespace understudy::calibration

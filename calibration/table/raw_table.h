// One table of a lab as its file has it, and the rows that it makes once its units are settled.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/table/column_map.h"
#include "machine/description.h"

namespace understudy::calibration {

/// The numbers of one table, still in its own units.
struct RawTable {
  TableMap map;
  std::string file;
  int index = 0;
  std::vector<std::vector<double>> joints, position, orientation, sigma_position, sigma_turn;
  std::vector<double> distance;
  std::vector<int> lines;
  std::vector<std::string> targets, ids;
  std::vector<std::string> notes;  ///< rows and sigmas that were not taken as they stand
};

/// Throws InputError for what cannot be read, for joints in a file of another length, and for units that the
/// headers of its columns contradict or nothing tells. A row whose measured numbers are missing (an empty
/// cell, NaN) is left out; a sigma of 0 among others is the least of the others. `id` names what the rows are
/// of where the map does not. Appends the bytes that it read to `bytes`.
RawTable read_raw(const TableMap& map, const std::string& file, const std::string& id,
                  const std::filesystem::path& joint_file, std::string& bytes);

/// Row by row in SI, by the units of `raw.map`. Throws InputError with the line of an orientation that is
/// none.
std::vector<MeasurementRow> rows_of(const RawTable& raw, const machine::MachineDescription& machine);

/// An axis whose readings a row has; of a hexapod a strut and its length.
struct RowAxis {
  std::string name;
  bool angle = false;
  double lower = 0, upper = 0;  ///< [rad] or [m]
};
std::vector<RowAxis> row_axes(const machine::MachineDescription& machine);

}  // namespace understudy::calibration

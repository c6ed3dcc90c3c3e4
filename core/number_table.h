// Tables of numbers in CSV, as poses, axes and curves come in.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace understudy {

struct NumberRow {
  int line = 0;
  std::vector<double> values;
};

/// Reads a CSV whose first line is exactly `header` (words separated by commas, spaces ignored). Empty lines
/// and lines that begin with # are passed over. Throws InputError with `name`, line and column for a missing
/// or different header, a wrong number of cells, and cells that are not finite numbers.
std::vector<NumberRow> read_number_table(std::istream& in, const std::string& name,
                                         const std::vector<std::string>& header);

}  // namespace understudy

// trace.csv of a rehearsal, read back as columns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understudy::report {

/// Columns of one length, in the units of trace_csv.h. NaN: an empty cell, which `gap_mm` may have.
struct TraceTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  int header_line = 0;     ///< of the file
  std::vector<int> lines;  ///< of the file, of each row

  std::size_t rows() const { return lines.size(); }
};

/// Throws InputError with file, line and column where the file cannot be read, is none of a rehearsal (its
/// first column is not time_s), was cut off, has rows of another length or a cell that is no finite number,
/// or goes back in time.
TraceTable read_trace_table(const std::filesystem::path& file);

}  // namespace understudy::report

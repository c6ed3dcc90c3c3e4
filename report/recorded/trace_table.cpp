#include "report/recorded/trace_table.h"

#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"

namespace understudy::report {
namespace {

constexpr const char* kFirst = "time_s";
constexpr const char* kMayBeEmpty = "gap_mm";

void read_header(const TextRow& row, const std::string& file, TraceTable& table) {
  for (const TextRow::Cell& cell : row.cells) table.names.push_back(cell.text);
  if (table.names.front() != kFirst)
    throw InputError(Place{file, row.line, 0},
                     fmt::format("this is no trace of a rehearsal: its first column is {}, not {}",
                                 table.names.front(), kFirst));
  table.columns.resize(table.names.size());
  table.header_line = row.line;
}

void read_row(const TextRow& row, const std::string& file, TraceTable& table) {
  if (row.cells.size() != table.names.size())
    throw InputError(Place{file, row.line, 0},
                     fmt::format("{} cells, where the header names {}: the trace is damaged",
                                 row.cells.size(), table.names.size()));
  for (std::size_t c = 0; c < row.cells.size(); ++c) {
    const TextRow::Cell& cell = row.cells[c];
    table.columns[c].push_back(cell.text.empty() && table.names[c] == kMayBeEmpty
                                   ? std::numeric_limits<double>::quiet_NaN()
                                   : table_number(cell, table.names[c], {file, row.line, cell.column}));
  }
  table.lines.push_back(row.line);
  const std::vector<double>& times = table.columns.front();
  if (times.size() > 1 && !(times.back() >= times[times.size() - 2]))
    throw InputError(Place{file, row.line, 0}, fmt::format("{} goes back from {:g} to {:g}", kFirst,
                                                           times[times.size() - 2], times.back()));
}

}  // namespace

TraceTable read_trace_table(const std::filesystem::path& path) {
  const std::string file = path.string(), text = read_file(file);
  if (!text.ends_with('\n'))
    throw InputError(Place{file}, "it has no end of line at its end: it was cut off");
  std::istringstream in(text);
  TraceTable table;
  TextRow row;
  if (!read_text_row(in, row)) throw InputError(Place{file}, "it is empty: this is no trace of a rehearsal");
  read_header(row, file, table);
  while (read_text_row(in, row)) read_row(row, file, table);
  return table;
}

}  // namespace understudy::report

#include "report/recorded_trace.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::report {
namespace {

enum Column : std::size_t { kTime, kLine, kExtruding, kTipError, kOrientationError, kGap, kPath, kColumns };
constexpr std::array<const char*, kColumns> kNames{
    "time_s", "line", "extruding", "tip_error_um", "orientation_error_mrad", "gap_mm", "path_mm"};
constexpr double kLineMax = 1e9;

class TraceReader {
 public:
  explicit TraceReader(std::string file) : file_(std::move(file)) {}

  void read_header(const TextRow& row) {
    for (const TextRow::Cell& cell : row.cells) header_.push_back(cell.text);
    for (std::size_t i = 0; i < kColumns; ++i) {
      const auto found = std::ranges::find(header_, kNames[i]);
      if (found == header_.end())
        throw InputError(Place{file_, row.line, 0},
                         fmt::format("column '{}' is missing: this is no trace of a rehearsal", kNames[i]));
      column_[i] = static_cast<std::size_t>(found - header_.begin());
    }
  }

  rehearsal::TracePoint point_of(const TextRow& row) const {
    if (row.cells.size() != header_.size())
      throw InputError(Place{file_, row.line, 0},
                       fmt::format("{} cells, where the header names {}: the trace is damaged",
                                   row.cells.size(), header_.size()));
    rehearsal::TracePoint point;
    point.time = number(row, kTime);
    const double line = number(row, kLine);
    if (line < 0 || line > kLineMax)
      throw InputError(place(row, kLine), fmt::format("line is {:g}, outside 0..{:g}", line, kLineMax));
    point.line = static_cast<int>(line);
    point.extruding = number(row, kExtruding) != 0;
    point.tip_error = 1e-6 * number(row, kTipError);
    point.orientation_error = 1e-3 * number(row, kOrientationError);
    const bool nothing_below = row.cells[column_[kGap]].text.empty();
    point.gap = nothing_below ? std::numeric_limits<double>::infinity() : from_mm(number(row, kGap));
    point.path = from_mm(number(row, kPath));
    return point;
  }

 private:
  Place place(const TextRow& row, Column which) const {
    return {file_, row.line, row.cells[column_[which]].column};
  }
  double number(const TextRow& row, Column which) const {
    return table_number(row.cells[column_[which]], kNames[which], place(row, which));
  }

  std::string file_;
  std::vector<std::string> header_;
  std::array<std::size_t, kColumns> column_{};
};

}  // namespace

std::vector<rehearsal::TracePoint> read_recorded_trace(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  if (!text.ends_with('\n'))
    throw InputError(Place{file.string()}, "it has no end of line at its end: it was cut off");
  std::istringstream in(text);
  TraceReader reader(file.string());
  TextRow row;
  if (!read_text_row(in, row))
    throw InputError(Place{file.string()}, "it is empty: this is no trace of a rehearsal");
  reader.read_header(row);
  std::vector<rehearsal::TracePoint> trace;
  while (read_text_row(in, row)) {
    trace.push_back(reader.point_of(row));
    if (trace.size() > 1 && trace.back().time < trace[trace.size() - 2].time)
      throw InputError(
          Place{file.string(), row.line, 0},
          fmt::format("time_s goes back from {:g} to {:g}", trace[trace.size() - 2].time, trace.back().time));
  }
  return trace;
}

}  // namespace understudy::report

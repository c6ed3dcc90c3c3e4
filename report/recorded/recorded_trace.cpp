#include "report/recorded/recorded_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "report/recorded/trace_table.h"

namespace understudy::report {
namespace {

enum Column : std::size_t { kTime, kLine, kExtruding, kTipError, kOrientationError, kGap, kPath, kColumns };
constexpr std::array<const char*, kColumns> kNames{
    "time_s", "line", "extruding", "tip_error_um", "orientation_error_mrad", "gap_mm", "path_mm"};
constexpr double kLineMax = 1e9;

using Columns = std::array<const std::vector<double>*, kColumns>;

Columns columns_of(const TraceTable& table, const std::string& file) {
  Columns columns{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto found = std::ranges::find(table.names, kNames[i]);
    if (found == table.names.end())
      throw InputError(Place{file, table.header_line, 0},
                       fmt::format("column '{}' is missing: this is no trace of a rehearsal", kNames[i]));
    columns[i] = &table.columns[static_cast<std::size_t>(found - table.names.begin())];
  }
  return columns;
}

int line_of(double value, const Place& place) {
  if (!(value >= 0 && value <= kLineMax))
    throw InputError(place, fmt::format("line is {:g}, outside 0..{:g}", value, kLineMax));
  return static_cast<int>(value);
}

}  // namespace

std::vector<rehearsal::TracePoint> read_recorded_trace(const std::filesystem::path& path) {
  const TraceTable table = read_trace_table(path);
  const Columns columns = columns_of(table, path.string());
  std::vector<rehearsal::TracePoint> trace(table.rows());
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const auto value = [&](Column which) { return (*columns[which])[row]; };
    rehearsal::TracePoint& point = trace[row];
    point.time = value(kTime);
    point.line = line_of(value(kLine), {path.string(), table.lines[row], 0});
    point.extruding = value(kExtruding) != 0;
    point.tip_error = 1e-6 * value(kTipError);
    point.orientation_error = 1e-3 * value(kOrientationError);
    const double gap = value(kGap);
    point.gap = std::isnan(gap) ? std::numeric_limits<double>::infinity() : from_mm(gap);
    point.path = from_mm(value(kPath));
  }
  return trace;
}

}  // namespace understudy::report

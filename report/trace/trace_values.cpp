#include "report/trace/trace_values.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/units.h"

namespace understudy::report {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

double axis_in_file_units(double value, const std::string& column) {
  if (ends_with(column, "_mm")) return to_mm(value);
  if (ends_with(column, "_deg")) return to_deg(value);
  throw std::logic_error("axis column " + column + " ends neither in _mm nor in _deg");
}

void append_pose(const Pose& X_WT, std::vector<double>& row) {
  for (int i = 0; i < 3; ++i) row.push_back(to_mm(X_WT.translation()[i]));
  Quat q(X_WT.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) row.push_back(c);
}

}  // namespace

std::vector<std::string> trace_columns(const rehearsal::Record& record) {
  std::vector<std::string> columns{"time_s", "line", "extruding"};
  for (const char* prefix : {"", "programmed_"})
    for (const char* name : {"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"})
      columns.push_back(std::string(prefix) + name);
  for (const char* name : {"tip_error_um", "orientation_error_mrad", "gap_mm", "path_mm"})
    columns.push_back(name);
  if (record.axes.size() > std::size_t{machine::kMaxAxes})
    throw std::logic_error("a record names more axes than a trace point has");
  for (const rehearsal::AxisColumn& axis : record.axes) columns.push_back(axis.name);
  return columns;
}

void trace_row(const rehearsal::TracePoint& point, const rehearsal::Record& record,
               const std::vector<std::string>& columns, std::vector<double>& row) {
  row.assign({point.time, static_cast<double>(point.line), point.extruding ? 1.0 : 0.0});
  append_pose(point.X_WT, row);
  append_pose(point.X_WT_programmed, row);
  row.push_back(to_um(point.tip_error));
  row.push_back(point.orientation_error * 1e3);
  row.push_back(to_mm(point.gap));
  row.push_back(to_mm(point.path));
  for (std::size_t i = 0; i < record.axes.size(); ++i)
    row.push_back(axis_in_file_units(point.axes[i], record.axes[i].name));
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool nothing_below = columns[i] == "gap_mm" && row[i] > 0 && std::isinf(row[i]);
    if (!std::isfinite(row[i]) && !nothing_below)
      throw std::logic_error("trace: " + columns[i] + " is not a finite number at " +
                             std::to_string(point.time) + " s");
  }
}

int column_decimals(const std::string& name) {
  if (name == "line" || name == "extruding") return 0;
  if (ends_with(name, "_s")) return 6;
  if (ends_with(name, "_um")) return 3;
  if (ends_with(name, "_mrad")) return 4;
  if (ends_with(name, "_deg")) return 7;
  if (ends_with(name, "_mm")) return 6;
  return 9;  // quaternions: 1e-9 of a turn moves the tip by less than a nanometre
}

std::vector<std::size_t> thin_out(const std::vector<rehearsal::TracePoint>& trace, std::size_t points_max) {
  std::vector<std::size_t> kept;
  if (trace.size() <= points_max) {
    for (std::size_t i = 0; i < trace.size(); ++i) kept.push_back(i);
    return kept;
  }
  // Differences below a nanometre are rounding: of values that are equal but for it, the first is kept.
  const auto gap = [&](std::size_t i) { return std::round(1e9 * trace[i].gap); };
  const auto tip_error = [&](std::size_t i) { return std::round(1e9 * trace[i].tip_error); };
  const std::size_t buckets = std::max<std::size_t>(1, points_max / 4);
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t begin = b * trace.size() / buckets, end = (b + 1) * trace.size() / buckets;
    if (begin == end) continue;
    std::size_t low = begin, high = begin, worst = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (gap(i) < gap(low)) low = i;
      const bool rises = gap(i) > gap(high) || std::isinf(gap(high));
      if (std::isfinite(gap(i)) && rises) high = i;
      if (tip_error(i) > tip_error(worst)) worst = i;
    }
    kept.insert(kept.end(), {begin, low, high, worst});
  }
  for (std::size_t i = 1; i < trace.size(); ++i)
    if (trace[i].extruding != trace[i - 1].extruding) kept.insert(kept.end(), {i - 1, i});
  kept.push_back(trace.size() - 1);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

}  // namespace understudy::report

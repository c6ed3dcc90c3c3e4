#include "report/trace/trace_csv.h"

#include <cmath>

#include <fmt/format.h>

#include "report/trace/trace_values.h"

namespace understudy::report {
namespace {

constexpr std::size_t kPiece = 100'000;  // bytes

}  // namespace

void make_trace_csv(const rehearsal::Record& record, const AppendPiece& append) {
  const std::vector<std::string> columns = trace_columns(record);
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  const auto out = std::back_inserter(text);
  std::vector<int> decimals;
  for (const std::string& column : columns) decimals.push_back(column_decimals(column));

  std::vector<double> row;
  for (const rehearsal::TracePoint& point : record.trace) {
    trace_row(point, record, columns, row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text.push_back(',');
      const bool rounds_to_zero = std::abs(row[i]) < 0.5 * std::pow(10.0, -decimals[i]);
      if (std::isfinite(row[i])) fmt::format_to(out, "{:.{}f}", rounds_to_zero ? 0.0 : row[i], decimals[i]);
    }
    text.push_back('\n');
    if (text.size() < kPiece) continue;
    append(text);
    text.clear();
  }
  append(text);
}

std::string trace_csv(const rehearsal::Record& record) {
  std::string text;
  make_trace_csv(record, [&](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace understudy::report

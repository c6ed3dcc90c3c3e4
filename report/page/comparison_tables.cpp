#include "report/page/comparison_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text/printable.h"

namespace understudy::report {
namespace {

constexpr std::size_t kWordMax = 60;  ///< characters of a cell
constexpr std::size_t kDigestShown = 12;
constexpr double kWholeMax = 1e12;  ///< counts below it are told whole

bool is_digest(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string input_cell(const std::optional<std::string>& value) {
  if (!value) return "-";
  return is_digest(*value) ? "sha256 " + value->substr(0, kDigestShown) : printable(*value, kWordMax);
}

WordTable inputs_table(const RehearsalComparison& comparison) {
  WordTable table{"Inputs that differ",
                  "Files by the beginning of their SHA-256; - where one has none.",
                  {"input", "A", "B"},
                  3,
                  {}};
  for (const InputChange& change : comparison.inputs)
    table.rows.push_back({printable(change.name, kWordMax), input_cell(change.a), input_cell(change.b)});
  return table;
}

std::string lines_cell(const KindOfFinding& kind) {
  if (kind.first_line == 0) return "-";
  return kind.last_line > kind.first_line ? fmt::format("{} to {}", kind.first_line, kind.last_line)
                                          : fmt::format("{}", kind.first_line);
}

WordTable findings_table(const RehearsalComparison& comparison) {
  WordTable table{"Findings",
                  "How many there are of each kind, and between which lines of the program.",
                  {"finding", "severity", "change", "lines in A", "lines in B", "A", "B"},
                  5,
                  {}};
  for (const ComparedFindings& each : comparison.findings)
    table.rows.push_back({printable(each.kind, kWordMax),
                          each.severity == rehearsal::Severity::error ? "error" : "warning",
                          word(each.change), lines_cell(each.a), lines_cell(each.b),
                          std::to_string(each.a.count), std::to_string(each.b.count)});
  return table;
}

std::string number_text(double value) {
  const bool whole = value == std::floor(value) && std::abs(value) < kWholeMax;
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

std::string figure_cell(const std::optional<regression::MetricValue>& value) {
  if (!value) return "-";
  if (const auto* number = std::get_if<double>(&*value)) return number_text(*number);
  return printable(std::get<std::string>(*value), kWordMax);
}

std::string difference_cell(const regression::MetricChange& change) {
  const auto difference = difference_of(change);
  return difference ? (*difference > 0 ? "+" : "") + number_text(*difference) : "";
}

/// Of A's value; nothing for less than the least that it shows.
std::string share_cell(const regression::MetricChange& change) {
  const auto difference = difference_of(change);
  if (!difference) return "";
  const double percent = 100 * *difference / std::abs(std::get<double>(*change.before));
  return std::isfinite(percent) && std::abs(percent) >= 0.05 ? fmt::format("{:+.1f} %", percent) : "";
}

WordTable figures_table(const RehearsalComparison& comparison) {
  WordTable table{"Figures that differ",
                  fmt::format("{} more are the same.", comparison.figures_same),
                  {"figure", "unit", "A", "B", "change", "of A"},
                  2,
                  {}};
  for (const regression::MetricChange& change : comparison.figures) {
    const std::string unit = regression::metric_unit(change.metric);
    table.rows.push_back({printable(change.metric, kWordMax), unit == "1" ? "" : unit,
                          figure_cell(change.before), figure_cell(change.after), difference_cell(change),
                          share_cell(change)});
  }
  return table;
}

}  // namespace

std::vector<WordTable> comparison_tables(const RehearsalComparison& comparison) {
  std::vector<WordTable> tables{inputs_table(comparison), findings_table(comparison),
                                figures_table(comparison)};
  std::erase_if(tables, [](const WordTable& table) { return table.rows.empty(); });
  return tables;
}

std::string verdict_change(const RecordedRehearsal& a, const RecordedRehearsal& b, const char* arrow) {
  const std::string before = rehearsal::headline(a.grade), after = rehearsal::headline(b.grade);
  return before == after ? before : before + arrow + after;
}

std::string comparison_text(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b) {
  std::string text =
      fmt::format("A: {}\nB: {}\n{}: {}\n", printable(a.folder.string()), printable(b.folder.string()),
                  verdict_change(a, b, " -> "), printable(comparison_sentence(comparison)));
  for (const WordTable& table : comparison_tables(comparison)) text += "\n" + plain_text(table);
  if (!comparison.curves.empty()) text += fmt::format("\nCurves differ: trace.csv: {}\n", comparison.curves);
  return text;
}

}  // namespace understudy::report

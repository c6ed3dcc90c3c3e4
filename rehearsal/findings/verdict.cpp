#include "rehearsal/findings/verdict.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "rehearsal/findings/finding_groups.h"

namespace understudy::rehearsal {
namespace {

std::string with_place(const FindingGroup& group) {
  std::string text = group.worst.message;
  if (!text.empty() && text.back() == '.') text.pop_back();
  if (const std::string extent = extent_of(group); !extent.empty()) text += " (" + extent + ")";
  return text;
}

int total(const std::vector<FindingGroup>& groups, Severity severity) {
  int count = 0;
  for (const FindingGroup& group : groups)
    if (group.worst.severity == severity) count += group.count;
  return count;
}

// 100.0 % means all of it. The small part makes up for a decimal fraction that binary cannot hold.
double percent_rounded_down(double fraction) { return std::floor(1000 * fraction + 1e-6) / 10; }

std::string enumerate(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  return text;
}

/// Nobody is to take the figures for those of the whole program.
std::string without_lines(const Record& record) {
  std::vector<std::string> lines;
  for (const auto& [first, last] : record.passed_over)
    lines.push_back(last > first ? fmt::format("{} to {}", first, last) : fmt::format("{}", first));
  if (lines.empty()) return "";
  const bool one = lines.size() == 1 && record.passed_over[0].first == record.passed_over[0].second;
  return fmt::format(" All figures are of the program without line{} {}.", one ? "" : "s", enumerate(lines));
}

std::string no_go_sentence(const Record& record) {
  const std::vector<FindingGroup> groups = group_findings(record);
  const int errors = total(groups, Severity::error);
  if (errors == 0) return "The rehearsal did not reach a go, and no finding says why.";
  std::string text = with_place(groups.front());
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (const int others = errors - groups.front().count; others > 0)
    text += fmt::format(", and {} other error{}", others, others > 1 ? "s" : "");
  if (!record.print) text += "; the program was not run";
  return text + "." + without_lines(record);
}

/// "flow and sag", each once.
std::string kinds_of(const std::vector<FindingGroup>& groups) {
  std::vector<std::string> kinds;
  for (const FindingGroup& group : groups) {
    std::string kind = group.worst.kind;
    std::replace(kind.begin(), kind.end(), '_', ' ');
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(std::move(kind));
  }
  return enumerate(kinds);
}

/// No limit is broken only where nothing was found at all: a warning may be of one.
std::string nothing_against(const Record& record) {
  const std::vector<FindingGroup> groups = group_findings(record);
  const int warnings = total(groups, Severity::warning);
  if (warnings == 0) return "No limit is broken";
  return fmt::format("Nothing stands against the print, with {} warning{} of {}", warnings,
                     warnings > 1 ? "s" : "", kinds_of(groups));
}

std::string go_sentence(const Record& record) {
  std::vector<std::string> clauses;
  if (record.gap)
    clauses.push_back(fmt::format("the gap starts at {:.3f} mm and is in the band over {:.1f} % of the path",
                                  record.gap->start_mm, percent_rounded_down(record.gap->in_band_fraction)));
  if (record.collision && record.collision->min_clearance_mm)
    clauses.push_back(fmt::format("nothing but the nozzle comes nearer than {:.2f} mm to anything",
                                  *record.collision->min_clearance_mm));
  if (record.accuracy)
    clauses.push_back(fmt::format("the tip errs by at most {:.0f} um", record.accuracy->tip_max_um));
  const std::string text = nothing_against(record);
  return clauses.empty() ? text + "." : text + ": " + enumerate(clauses) + ".";
}

}  // namespace

Grade grade_of(const Record& record) {
  if (!record.go) return Grade::no_go;
  return record.findings.empty() ? Grade::go : Grade::go_with_warnings;
}

const char* word(Grade grade) {
  switch (grade) {
    case Grade::go:
      return "go";
    case Grade::go_with_warnings:
      return "go-with-warnings";
    case Grade::no_go:
      break;
  }
  return "no-go";
}

std::optional<Grade> grade_of_word(const std::string& text) {
  for (const Grade grade : {Grade::go, Grade::go_with_warnings, Grade::no_go})
    if (text == word(grade)) return grade;
  return std::nullopt;
}

const char* headline(Grade grade) {
  switch (grade) {
    case Grade::go:
      return "GO";
    case Grade::go_with_warnings:
      return "GO with warnings";
    case Grade::no_go:
      break;
  }
  return "NO-GO";
}

std::string verdict_sentence(const Record& record) {
  return record.go ? go_sentence(record) : no_go_sentence(record);
}

}  // namespace understudy::rehearsal

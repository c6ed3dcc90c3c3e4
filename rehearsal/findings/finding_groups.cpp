#include "rehearsal/findings/finding_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "rehearsal/findings/advice.h"

namespace understudy::rehearsal {
namespace {

double excess(const Finding& finding) { return std::abs(finding.value - finding.limit); }

/// From causes to consequences. A tip error comes before the contacts that it explains, else after them.
constexpr std::array kFromCauseToConsequence{"program",        "limit",    "stop", "accuracy", "collision",
                                             "other accuracy", "gap",      "flow", "adhesion", "sag",
                                             "assumption",     "unchecked"};

std::string_view stage_of(const Finding& finding, bool tip_error_explains_contacts) {
  if (finding.about == kStopped) return "stop";
  if (finding.kind == "accuracy") return tip_error_explains_contacts ? "accuracy" : "other accuracy";
  for (const std::string_view kind : {"near_collision", "gouge", "left_over"})
    if (finding.kind == kind) return "gap";
  for (const std::string_view kind :
       {"program", "collision", "gap", "flow", "adhesion", "sag", "assumption", "unchecked"})
    if (finding.kind == kind) return kind;
  return "limit";
}

int rank_of(const Finding& finding, bool tip_error_explains_contacts) {
  const auto stage = std::find(kFromCauseToConsequence.begin(), kFromCauseToConsequence.end(),
                               stage_of(finding, tip_error_explains_contacts));
  return static_cast<int>(stage - kFromCauseToConsequence.begin());
}

bool tip_error_explains_contacts(const Record& record) {
  double deepest_mm = 0;
  for (const Finding& finding : record.findings)
    if (finding.kind == "collision" && finding.severity == Severity::error)
      deepest_mm = std::max(deepest_mm, -finding.value);
  return tip_error_explains(record, deepest_mm);
}

void add(const Finding& finding, FindingGroup& group) {
  if (finding.gcode_line > 0) {
    const int last = std::max(finding.gcode_line, finding.last_line);
    group.first_line =
        group.first_line > 0 ? std::min(group.first_line, finding.gcode_line) : finding.gcode_line;
    group.last_line = std::max(group.last_line, last);
  }
  if (excess(finding) > excess(group.worst)) group.worst = finding;
}

}  // namespace

std::vector<FindingGroup> group_findings(const Record& record) {
  std::vector<FindingGroup> groups;
  std::map<std::tuple<Severity, std::string, std::string>, std::size_t> known;
  for (const Finding& finding : record.findings) {
    const auto [entry, is_new] =
        known.try_emplace({finding.severity, finding.kind, finding.about}, groups.size());
    if (is_new)
      groups.push_back({finding, 1, 0, 0, {}});
    else
      ++groups[entry->second].count;
    add(finding, groups[entry->second]);
  }
  for (FindingGroup& group : groups) group.advice = advice(group.worst, record);
  const bool explained = tip_error_explains_contacts(record);
  const auto order = [&](const FindingGroup& group) {
    return std::tuple(group.worst.severity != Severity::error, rank_of(group.worst, explained),
                      group.first_line);
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const FindingGroup& a, const FindingGroup& b) { return order(a) < order(b); });
  return groups;
}

std::string extent_of(const FindingGroup& group) {
  std::string text;
  if (group.first_line > 0)
    text = group.last_line > group.first_line
               ? fmt::format("lines {} to {}", group.first_line, group.last_line)
               : fmt::format("line {}", group.first_line);
  if (group.count > 1) text += fmt::format("{}{} times", text.empty() ? "" : ", ", group.count);
  return text;
}

}  // namespace understudy::rehearsal

#include "report/summary_json.h"

#include <type_traits>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "rehearsal/figures.h"
#include "rehearsal/findings/finding_groups.h"
#include "rehearsal/findings/verdict.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using rehearsal::Finding;
using rehearsal::FindingGroup;
using rehearsal::Severity;
using Json = nlohmann::ordered_json;

void put(Json& object, const char* key, double value) { object[key] = stable_number(value, key); }

const char* severity_word(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

Json finding_value(const Finding& finding) {
  Json object;
  object["kind"] = finding.kind;
  object["severity"] = severity_word(finding.severity);
  if (finding.gcode_line > 0) object["gcode_line"] = finding.gcode_line;
  put(object, "time_s", finding.time_s);
  put(object, "value", finding.value);
  put(object, "limit", finding.limit);
  object["unit"] = finding.unit;
  object["message"] = finding.message;
  return object;
}

/// What findings that are alike have in common; each of them stands among the findings.
Json group_value(const FindingGroup& group) {
  Json object;
  object["kind"] = group.worst.kind;
  object["severity"] = severity_word(group.worst.severity);
  object["count"] = group.count;
  if (group.first_line > 0) {
    object["first_line"] = group.first_line;
    object["last_line"] = group.last_line;
  }
  object["worst"] = finding_value(group.worst);
  if (!group.advice.empty()) object["advice"] = group.advice;
  return object;
}

Json figure_value(const rehearsal::Figure& figure) {
  return std::visit(
      [&](const auto& value) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
          return stable_number(value, figure.name.c_str());
        else
          return value;
      },
      figure.value);
}

}  // namespace

Json summary_value(const rehearsal::Record& record) {
  Json summary;
  summary["schema"] = "understudy.rehearsal/1";
  summary["verdict"] = record.go ? "go" : "no-go";
  summary["go"] = record.go;
  summary["grade"] = word(rehearsal::grade_of(record));
  for (const auto& [first, last] : record.passed_over)
    summary["passed_over"].push_back(Json::array({first, last}));
  summary["findings"] = Json::array();
  for (const Finding& finding : record.findings) summary["findings"].push_back(finding_value(finding));
  summary["finding_groups"] = Json::array();
  for (const FindingGroup& group : rehearsal::group_findings(record))
    summary["finding_groups"].push_back(group_value(group));
  for (const rehearsal::Figure& figure : rehearsal::figures(record))
    summary[figure.section][figure.name] = figure_value(figure);
  return summary;
}

std::string timing_json(const rehearsal::Record& record) {
  Json timing;
  timing["schema"] = "understudy.timing/1";
  for (const rehearsal::Figure& figure : rehearsal::timing_figures(record))
    timing[figure.name] = figure_value(figure);
  return to_text(timing, 2) + "\n";
}

std::string summary_json(const rehearsal::Record& record) { return to_text(summary_value(record), 2) + "\n"; }

}  // namespace understudy::report

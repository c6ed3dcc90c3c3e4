#include "report/comparison_json.h"

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;

Json result_value(const RecordedRehearsal& result) {
  return {{"folder", result.folder.string()},       {"verdict", result.run.go ? "go" : "no-go"},
          {"grade", rehearsal::word(result.grade)}, {"version", result.run.version},
          {"command", result.run.command},          {"inputs_sha256", result.run.inputs_sha256}};
}

Json inputs_value(const RehearsalComparison& comparison) {
  Json changes = Json::array();
  for (const InputChange& change : comparison.inputs) {
    Json each{{"name", change.name}};
    if (change.a) each["a"] = *change.a;
    if (change.b) each["b"] = *change.b;
    changes.push_back(each);
  }
  return {{"same", comparison.same_inputs}, {"differ", changes}};
}

Json kind_value(const KindOfFinding& kind) {
  Json value{{"count", kind.count}};
  if (kind.first_line > 0) {
    value["first_line"] = kind.first_line;
    value["last_line"] = kind.last_line;
  }
  if (!kind.worst.empty()) value["worst"] = kind.worst;
  return value;
}

Json findings_value(const RehearsalComparison& comparison) {
  Json all = Json::array();
  for (const ComparedFindings& each : comparison.findings)
    all.push_back({{"kind", each.kind},
                   {"severity", each.severity == rehearsal::Severity::error ? "error" : "warning"},
                   {"change", word(each.change)},
                   {"a", kind_value(each.a)},
                   {"b", kind_value(each.b)}});
  return all;
}

void put(Json& object, const char* key, const std::optional<regression::MetricValue>& value) {
  if (!value) return;
  std::visit([&](const auto& held) { object[key] = held; }, *value);
}

Json figures_value(const RehearsalComparison& comparison) {
  Json changes = Json::array();
  for (const regression::MetricChange& change : comparison.figures) {
    Json each{{"figure", change.metric}};
    put(each, "a", change.before);
    put(each, "b", change.after);
    if (const auto difference = difference_of(change))
      each["change"] = stable_number(*difference, change.metric.c_str());
    changes.push_back(each);
  }
  return {{"same", comparison.figures_same}, {"differ", changes}};
}

Json curves_value(const RehearsalComparison& comparison) {
  Json value{{"same", comparison.curves.empty()}};
  if (!comparison.curves.empty()) value["differ"] = comparison.curves;
  return value;
}

}  // namespace

std::string comparison_json(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b) {
  const Json document{{"schema", "understudy.comparison/1"},
                      {"differs", comparison.differs()},
                      {"a", result_value(a)},
                      {"b", result_value(b)},
                      {"inputs", inputs_value(comparison)},
                      {"findings", findings_value(comparison)},
                      {"figures", figures_value(comparison)},
                      {"curves", curves_value(comparison)}};
  return to_text(document, 2) + "\n";
}

}  // namespace understudy::report

#include "report/scenario_results_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using regression::MetricValue;

/// A figure of a series may be infinite, which JSON has no number for.
void put(Json& object, const char* key, const std::optional<MetricValue>& value) {
  if (!value) return;
  if (const auto* number = std::get_if<double>(&*value); number && !std::isfinite(*number))
    object[key] = regression::text_of(value, "1");
  else
    std::visit([&](const auto& held) { object[key] = held; }, *value);
}

Json check_value(const regression::Check& check) {
  Json value{{"name", check.name}, {"passed", check.ok}};
  put(value, "value", check.value);
  if (!check.ok) value["message"] = check.message;
  return value;
}

Json scenario_value(const ToldScenario& scenario) {
  const regression::ScenarioResult& result = scenario.result;
  Json value{{"name", result.name}, {"file", result.file}, {"passed", result.passed()}};
  if (result.seconds) value["seconds"] = *result.seconds;
  if (!result.error.empty()) value["error"] = result.error;
  if (!result.report.empty()) value["report"] = result.report;
  value["checks"] = Json::array();
  for (const regression::Check& check : result.checks) value["checks"].push_back(check_value(check));
  for (const regression::MetricChange& change : scenario.changes) {
    Json each{{"figure", change.metric}};
    put(each, "was", change.before);
    put(each, "is", change.after);
    value["changes"].push_back(each);
  }
  return value;
}

}  // namespace

std::string scenario_results_json(std::span<const ToldScenario> scenarios) {
  const auto passed =
      std::ranges::count_if(scenarios, [](const ToldScenario& each) { return each.result.passed(); });
  Json document{{"schema", "understudy.scenarios/1"},
                {"passed", passed},
                {"failed", std::ssize(scenarios) - passed},
                {"scenarios", Json::array()}};
  for (const ToldScenario& scenario : scenarios) document["scenarios"].push_back(scenario_value(scenario));
  return to_text(document, 2) + "\n";
}

}  // namespace understudy::report

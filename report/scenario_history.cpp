#include "report/scenario_history.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/json_depth.h"
#include "core/version.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;

PastRun run_of(const Json& line) {
  PastRun run;
  run.time = line.at("time").get<std::string>();
  for (const auto& [name, past] : line.at("scenarios").items()) {
    PastScenario& scenario = run.scenarios[name];
    scenario.passed = past.at("passed").get<bool>();
    scenario.seconds = past.at("seconds").get<double>();
    for (const auto& [check, value] : past.at("values").items()) scenario.values[check] = value.get<double>();
  }
  return run;
}

}  // namespace

std::string history_line(const std::string& time, std::span<const regression::ScenarioResult> results) {
  Json line{{"time", time}, {"version", kVersion}, {"scenarios", Json::object()}};
  for (const regression::ScenarioResult& result : results) {
    Json values = Json::object();
    for (const regression::Check& check : result.checks)
      if (check.value && std::holds_alternative<double>(*check.value))
        values[check.name] = std::get<double>(*check.value);
    line["scenarios"][result.name] = {
        {"passed", result.passed()}, {"seconds", result.seconds.value_or(0)}, {"values", values}};
  }
  return line.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::vector<PastRun> read_history(const std::string& text, const std::string& file) {
  std::vector<PastRun> runs;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      if (nests_deeper(line)) throw std::runtime_error("it is nested too deep");
      runs.push_back(run_of(Json::parse(line)));
    } catch (const std::exception& error) {
      if (lines.eof()) break;  // no line end: the run was killed as it wrote
      throw InputError(Place{file, number, 0},
                       std::string("not a line of a scenario history; move the file away: ") + error.what());
    }
  }
  return runs;
}

}  // namespace understudy::report

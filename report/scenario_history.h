// Earlier runs of a folder of scenarios, for the trend on its index page.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "regression/scenario_checks.h"

namespace understudy::report {

struct PastScenario {
  bool passed = false;
  double seconds = 0;
  std::map<std::string, double> values;  ///< by the check's name, of those that are numbers
};

struct PastRun {
  std::string time;                               ///< ISO 8601, UTC
  std::map<std::string, PastScenario> scenarios;  ///< by name
};

/// One line of JSON, with its end.
std::string history_line(const std::string& time, std::span<const regression::ScenarioResult> results);

/// Oldest first. Throws InputError with file and line for what is no such line; a last line that was cut off
/// by a kill does not count.
std::vector<PastRun> read_history(const std::string& text, const std::string& file);

}  // namespace understudy::report

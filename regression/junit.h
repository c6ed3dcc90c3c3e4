// Results of scenarios as JUnit XML, for whatever shows test results.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "regression/scenario.h"

namespace understudy::rehearsal {

struct ScenarioResult {
  std::string name;  ///< of the scenario
  std::string file;
  std::vector<Check> checks;
  std::string error;              ///< why it could not be judged; empty when it was
  std::optional<double> seconds;  ///< wall time; left out of files that must be reproducible
  bool passed() const;
};

/// A test suite a scenario, a test case an expectation.
std::string junit_xml(std::span<const ScenarioResult> results);

}  // namespace understudy::rehearsal

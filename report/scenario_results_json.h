// The answer of `understudy scenario run --json`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "regression/scenario_checks.h"
#include "regression/scenario_outcome.h"

namespace understudy::report {

struct ToldScenario {
  regression::ScenarioResult result;
  std::vector<regression::MetricChange> changes;  ///< from the baseline
};

/// "understudy.scenarios/1" (docs/scenarios.md). Keys whose value does not exist are left out.
std::string scenario_results_json(std::span<const ToldScenario> scenarios);

}  // namespace understudy::report

// Results of scenarios as JUnit XML, for whatever shows test results.
#pragma once

#include <span>
#include <string>

#include "regression/scenario_checks.h"

namespace understudy::regression {

/// A test suite a scenario, a test case an expectation.
std::string junit_xml(std::span<const ScenarioResult> results);

}  // namespace understudy::regression

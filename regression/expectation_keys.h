// The list `expect` of a scenario file.
#pragma once

#include <vector>

#include "core/yaml/yaml_map.h"
#include "regression/scenario.h"

namespace understudy::regression {

/// The entries of `expect` in `parent`; under `machines` each is a statistic over all of them. Throws
/// InputError with file and line on an unknown metric, a bound without the metric's unit, or no bound at all.
std::vector<Expectation> read_expectations(YamlMap& parent, bool over_machines);

}  // namespace understudy::regression

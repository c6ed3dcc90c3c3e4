// The list `expect` of a scenario file.
#pragma once

#include <vector>

#include "core/yaml/yaml_map.h"
#include "regression/scenario.h"

namespace understudy::regression {

/// Of a rehearsal; of a series of machines, each a statistic over all of them; of what a command wrote, whose
/// figures have names that only it knows.
enum class FiguresOf { run, machines, command };

/// The entries of `expect` in `parent`. Throws
/// InputError with file and line on an unknown metric, a bound without the metric's unit, or no bound at all.
std::vector<Expectation> read_expectations(YamlMap& parent, FiguresOf of);

}  // namespace understudy::regression

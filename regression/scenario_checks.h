// Judges what a scenario expects.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "regression/scenario.h"

namespace understudy::regression {

/// One expectation, judged.
struct Check {
  Expectation expectation;
  std::optional<MetricValue> value;  ///< nothing: the run has no such figure
  bool ok = false;
  std::string name;     ///< "gap.start_mm in 0.1..0.2 mm"
  std::string message;  ///< "gap.start_mm is 0.412 mm, above 0.2 mm (scenario.yaml:14)"
};

/// A figure that is absent never passes. `machines` holds one entry per seed of the series, in order; a
/// figure absent on some of them fails every statistic but fraction_within, where it is held against the
/// bound: outside for a lower bound, inside for an upper one. Last come the figures of the golden file.
std::vector<Check> evaluate(const Scenario& scenario, const Metrics& run, std::span<const Metrics> machines);

struct ScenarioResult {
  std::string name;  ///< of the scenario
  std::string file;
  std::vector<Check> checks;
  std::string error;              ///< why it could not be judged; empty when it was
  std::optional<double> seconds;  ///< wall time; left out of files that must be reproducible
  int error_status = 0;           ///< of a rehearsal that ended so: 2 bad input, 3 the machine failed
  std::string report = {};        ///< path of its page; empty: none was written
  bool passed() const;
};

}  // namespace understudy::regression

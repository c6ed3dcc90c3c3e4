// What came of the runs of a scenario, before it is judged; as a file it is judged again without a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "regression/scenario_checks.h"

namespace understudy::regression {

struct ScenarioOutcome {
  Metrics run;
  std::vector<Metrics> machines;  ///< of the series, in the order of the seeds
  std::string error;     ///< why there is no result; empty when there is one, or a refusal is expected
  int error_status = 0;  ///< of a rehearsal that ended so: 2 bad input, 3 the machine failed
  double seconds = 0;    ///< wall time
};

/// Throws logic_error where the series does not have the scenario's machines.
ScenarioResult judge(const Scenario& scenario, const ScenarioOutcome& outcome);

/// SHA-256 of all that the outcome depends on: inputs of the rehearsal (rehearsal/request/input_digest.h),
/// seeds of the series and the figures that are asked of it. `sources_sha256`: of what a planned program is
/// made from, or of a command and all that it reads. Empty where an input cannot be read.
std::string outcome_inputs(const Scenario& scenario, const std::string& sources_sha256);

/// Of machines, only the figures that the scenario's series asks for.
std::string outcome_text(const Scenario& scenario, const ScenarioOutcome& outcome, const std::string& inputs);

struct RecordedOutcome {
  ScenarioOutcome outcome;
  std::string inputs;  ///< as outcome_inputs() told them
};

/// Throws InputError with file and line for a file of another form or version.
RecordedOutcome load_outcome(const std::filesystem::path& path);

/// A figure that one of two runs has not, or that they have in different sizes.
struct MetricChange {
  std::string metric;
  std::optional<MetricValue> before, after;
};

/// Sorted by name. Times, versions and digests do not count.
std::vector<MetricChange> changes(const Metrics& before, const Metrics& after);
/// "gap.start_mm was 0.134198 mm, is 0.151 mm".
std::string text_of(const MetricChange& change);

}  // namespace understudy::regression

// The figures of one rehearsal under dotted names, as scenarios speak of them: "gap.start_mm", "verdict".
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rehearsal/record.h"

namespace understudy::regression {

using MetricValue = std::variant<double, std::string>;
using Metrics = std::map<std::string, MetricValue>;

/// The figures of a record as its summary.json tells them, to six significant digits. Besides: `verdict`,
/// `exit_status` (0 go, 1 no-go), `findings.count`, `findings.error.count`, `findings.warning.count` and
/// `findings.<kind>.count`. A kind that this run did not look for (no collision section: no collision check)
/// has no count; zero means looked for and not found.
Metrics metrics_of(const rehearsal::Record& record);

/// A run that ended without a summary: bad input (2) or a failed engine (3).
Metrics failed_run(int exit_status);

/// Every name that a scenario may use.
const std::vector<std::string>& metric_names();

/// Values of this metric are words (verdict, engine.name), not numbers.
bool metric_is_text(const std::string& metric);

/// This metric exists for the machines of a series only, not for a single run.
bool metric_is_of_series(const std::string& metric);

/// The unit that the name ends in: "mm", "um", "mrad", "mm3", "s"; "1" for counts and fractions; empty for
/// text.
std::string metric_unit(const std::string& metric);

/// Tells of the run or the computer, not of the print: times, the engine's version, hashes and versions of
/// inputs.
bool metric_is_of_the_run(const std::string& metric);

/// The number with its unit, "0.41 mm"; alone where the unit is "1" or empty.
std::string text_with_unit(double value, const std::string& unit);
/// A number with its unit, a word as it is, or "absent".
std::string text_of(const std::optional<MetricValue>& value, const std::string& unit);

}  // namespace understudy::regression

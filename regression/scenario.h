// A scenario: a rehearsal with what is expected of it, as a file that CI runs (docs/scenarios.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "regression/metrics.h"
#include "regression/scenario_faults.h"
#include "rehearsal/rehearse.h"

namespace understudy::rehearsal {

/// `none`: one run. The others gather one metric over many machines.
enum class Statistic { none, min, max, mean, median, p95, fraction_within };
const char* to_string(Statistic s);

/// One metric and what it must be: min and max (either or both), or equals.
struct Expectation {
  std::string metric;
  Statistic statistic = Statistic::none;
  double within_min = 0, within_max = 0;  ///< fraction_within: in the metric's unit, ends included
  std::optional<double> min, max;         ///< in the metric's unit; for fraction_within 0..1
  std::optional<MetricValue> equals;
  double tolerance = 0;  ///< of a number that must be equal
  std::string unit;      ///< the metric's; "1" for counts and fractions
  std::string source;    ///< where the bound comes from
  int line = 0;          ///< in the scenario file
};

/// The same program on machines built by consecutive seeds.
struct MachineSeries {
  std::uint64_t seed_first = 0, seed_last = 0;  ///< both included
  std::vector<Expectation> expect;
  std::uint64_t count() const { return seed_last - seed_first + 1; }
};

struct Scenario {
  std::filesystem::path file;
  std::string name, description, source;
  std::string machine;  ///< name of a model, or a path
  std::filesystem::path program;
  std::string fixture;   ///< name or path of an STL; empty: none
  std::string as_built;  ///< nominal, sampled, manufactured or a path
  std::uint64_t seed = 0;
  std::string gap_control, engine;
  std::string material;    ///< empty: the machine's
  DialectRequest dialect;  ///< how the program is read
  SurfaceRequest surface;  ///< what is asked about the surface
  std::vector<FaultRequest> faults;
  std::vector<Expectation> expect;  ///< of the run with `seed`
  std::optional<MachineSeries> machines;
};

/// Paths in the file are relative to it; here they are not any more. Throws InputError with file and line for
/// an unknown key or word (naming the nearest known one), a missing key, a wrong type, a file that is not
/// there, an expectation without a bound, and a unit that is not the metric's.
Scenario load_scenario(const std::filesystem::path& path);

/// Scenario files among `paths`: files as they are, folders by their *.yaml, sorted. Throws InputError for a
/// path that does not exist and a folder without scenarios.
std::vector<std::filesystem::path> find_scenarios(std::span<const std::filesystem::path> paths);

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
/// bound: outside for a lower bound, inside for an upper one.
std::vector<Check> evaluate(const Scenario& scenario, const Metrics& run, std::span<const Metrics> machines);

}  // namespace understudy::rehearsal

// A scenario: a rehearsal with what is expected of it, as a file that CI runs (docs/scenarios.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "regression/metrics.h"
#include "rehearsal/request/request.h"

namespace understudy::regression {

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
  std::string command;            ///< what follows `understudy`, of a study; empty: this is a rehearsal
  std::string machine;            ///< name of a model, or a path
  std::filesystem::path program;  ///< empty: `plan` makes it
  std::string plan;               ///< what follows `understudy plan`; empty: there is a file
  std::string fixture;            ///< name or path of an STL; empty: none
  std::string as_built;           ///< nominal, sampled, manufactured, calibrated or a path
  std::uint64_t seed = 0;
  std::string gap_control, engine;
  std::optional<double> tip_tolerance_mm, orientation_tolerance_deg;  ///< without one, the machine's
  std::string material;                                               ///< empty: the machine's
  rehearsal::DialectRequest dialect;                                  ///< how the program is read
  rehearsal::SurfaceRequest surface;                                  ///< what is asked about the surface
  rehearsal::RegistrationRequest registration;                        ///< of the part, before the print
  std::string part_pose;                                              ///< path of what `register` wrote
  std::vector<rehearsal::FaultRequest> faults;
  std::vector<rehearsal::CameraFaultRequest> camera_faults;
  std::vector<Expectation> expect;  ///< of the run with `seed`
  std::vector<Expectation> golden;  ///< figures of an earlier run (golden_file.h); empty: there is no file
  std::optional<MachineSeries> machines;
};

}  // namespace understudy::regression

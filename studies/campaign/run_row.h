// What is kept of a run: a row of the result store.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "regression/metrics.h"
#include "studies/campaign/sampling.h"

namespace understudy::studies {

/// How a run ended. Those after `no_go` have no answer.
enum class RunEnd {
  go,
  no_go,
  refused,  ///< bad input: the program cannot be planned, or the values do not go together
  failed,   ///< the engine failed
  crashed,  ///< the process died of a signal that says so
};
const char* to_string(RunEnd end);
/// Throws InputError for another word.
RunEnd run_end(const std::string& word);

struct RunRow {
  std::uint64_t index = 0, seed = 0;
  std::string scenario;  ///< its name
  ParameterValues values;
  RunEnd end = RunEnd::go;
  std::string error;           ///< why there is no answer
  std::string command;         ///< that makes the run's summary.json again
  std::string summary_sha256;  ///< of that file; empty without an answer
  double seconds = 0;          ///< wall time; no part of any table
  /// Numbers by name, of row_metrics(); what the run has not is not there.
  regression::Metrics metrics;

  bool answered() const { return end == RunEnd::go || end == RunEnd::no_go; }
};

/// The figures that a row has columns for: numbers that do not depend on the computer.
const std::vector<std::string>& row_metrics();

}  // namespace understudy::studies

// benchmark.json, and the lines for a terminal.
#pragma once

#include <string>

#include "studies/calibration/calibration_benchmark.h"

namespace understudy::report {

/// benchmark.json. Wall times are under "timing" alone.
std::string benchmark_json(const studies::CalibrationBenchmark& benchmark);
/// For a terminal.
std::string benchmark_table(const studies::CalibrationBenchmark& benchmark);

}  // namespace understudy::report

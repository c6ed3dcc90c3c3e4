// report.html of the calibration benchmark: ranking, charts and every figure in one file.
#pragma once

#include <string>

#include "studies/calibration/calibration_benchmark.h"

namespace understudy::report {

/// Without scripts or network.
std::string benchmark_page(const studies::CalibrationBenchmark& benchmark);

}  // namespace understudy::report

// gap.json, the lines for a terminal and the page of the gap benchmark.
#pragma once

#include <string>

#include "studies/gap/gap_benchmark.h"

namespace understudy::report {

std::string gap_benchmark_json(const studies::GapBenchmark& benchmark);
std::string gap_benchmark_html(const studies::GapBenchmark& benchmark);
std::string gap_benchmark_table(const studies::GapBenchmark& benchmark);  ///< for a terminal

}  // namespace understudy::report

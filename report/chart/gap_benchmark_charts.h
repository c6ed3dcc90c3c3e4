// Drawings of the gap benchmark's page, as SVG text.
#pragma once

#include <string>

#include "studies/gap/gap_benchmark.h"

namespace understudy::report {

/// The gap along the bottle's line mode by mode, the share in the band, the scatter of the detectors; what
/// was not run is left out.
std::string gap_benchmark_charts(const studies::GapBenchmark& benchmark);

}  // namespace understudy::report

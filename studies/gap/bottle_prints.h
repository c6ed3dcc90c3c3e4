// Private to the gap benchmark: the bottle's line on many built machines.
#pragma once

#include "studies/gap/gap_benchmark.h"

namespace understudy::studies {

/// One machine with one mode.
struct BottlePrint {
  bool printed = false, touched = false;
  std::vector<double> gaps_mm;
  double in_band = 0;
  std::string stop;
};

BottlePrint print_bottle(const GapBenchmarkRequest& request, const std::string& mode, std::uint64_t seed);

/// All machines of one mode.
BottleRow bottle_row(const std::string& mode, const std::vector<BottlePrint>& prints);

}  // namespace understudy::studies

// What many runs say, with its uncertainty.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace understudy::studies {

/// Between `low` and `high` lies the truth, with the level that was asked for.
struct Interval {
  double value = 0, low = 0, high = 1;
};

/// `count` of `runs`: the share, and the exact interval of the probability behind it (Clopper and Pearson
/// 1934), which holds the truth at least as often as `level` says, whatever the probability. Of no runs: 0
/// to 1.
Interval binomial_interval(std::uint64_t count, std::uint64_t runs, double level);

/// The quantile (core/quantile.h) of the values, and the percentiles of 1000 bootstrap resamples of it. Equal
/// values and `purpose` give equal numbers, whatever the order of the values. NaN where there are none.
Interval quantile_interval(std::vector<double> values, double share, double level,
                           const std::string& purpose);

}  // namespace understudy::studies

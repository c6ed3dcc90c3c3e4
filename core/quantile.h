// One definition of a quantile for tables and scenario checks.
#pragma once

#include <vector>

namespace understudy {

/// Linear interpolation between order statistics; `share` in [0, 1]; `values` need not be sorted and may
/// be infinite. NaN when there are none.
double quantile(std::vector<double> values, double share);

}  // namespace understudy

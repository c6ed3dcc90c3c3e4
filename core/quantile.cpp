#include "core/quantile.h"

#include <algorithm>
#include <cmath>

namespace understudy {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, values.size() - 1);
  const double beyond = at - static_cast<double>(below);
  if (beyond == 0 || std::isinf(values[below])) return values[below];  // infinity less infinity is no number
  return values[below] + beyond * (values[above] - values[below]);
}

}  // namespace understudy

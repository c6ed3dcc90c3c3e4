#include "studies/campaign/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>

#include "core/quantile.h"
#include "core/random.h"

namespace understudy::studies {
namespace {

constexpr int kResamples = 1000;

/// A quantile of a resample of `sorted`. Of n draws from them the k-th smallest is sorted[n U], where U is
/// the k-th smallest of n uniform numbers: a beta number. So a resample costs two draws, not n.
double resampled_quantile(const std::vector<double>& sorted, double share, Random& random) {
  const auto n = static_cast<double>(sorted.size());
  const double position = share * (n - 1), below = std::floor(position);
  const auto value_at = [&](double uniform) {
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(n * uniform))];
  };
  const double first = boost::math::ibeta_inv(below + 1, n - below, random.uniform());
  const double low = value_at(first);
  if (below + 1 >= n) return low;
  const double rest = 1 - std::pow(1 - random.uniform(), 1 / (n - below - 1));  // the smallest of those above
  const double high = value_at(first + (1 - first) * rest);
  return low == high ? low : low + (position - below) * (high - low);
}

}  // namespace

Interval binomial_interval(std::uint64_t count, std::uint64_t runs, double level) {
  if (runs == 0) return {0, 0, 1};
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(runs), k = static_cast<double>(count);
  const double tail = (1 - level) / 2;
  return {k / n, count == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, tail),
          count == runs ? 1 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

Interval quantile_interval(std::vector<double> values, double share, double level,
                           const std::string& purpose) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNone, kNone, kNone};
  std::sort(values.begin(), values.end());
  Random random(1, "bootstrap of " + purpose);
  std::vector<double> resampled(kResamples);
  for (double& one : resampled) one = resampled_quantile(values, share, random);
  const double tail = (1 - level) / 2;
  return {quantile(values, share), quantile(resampled, tail), quantile(resampled, 1 - tail)};
}

}  // namespace understudy::studies

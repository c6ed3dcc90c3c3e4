#include "studies/budget/sobol_indices.h"

#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/assert.h"
#include "core/quantile.h"
#include "core/random.h"

namespace understudy::studies {
namespace {

/// Squared differences, pair by pair: all that the estimators need.
struct Squares {
  std::vector<double> ab;
  std::vector<std::vector<double>> am, bm;  // by group
};

std::vector<double> squares(const std::vector<double>& x, const std::vector<double>& y) {
  UNDERSTUDY_ASSERT(x.size() == y.size(), "a design has every output of every pair");
  std::vector<double> all;
  for (std::size_t i = 0; i < x.size(); ++i) all.push_back((x[i] - y[i]) * (x[i] - y[i]));
  return all;
}

Squares squares_of(const PickFreeze& outputs) {
  Squares all;
  all.ab = squares(outputs.a, outputs.b);
  for (const auto& mixed : outputs.mixed) {
    all.am.push_back(squares(outputs.a, mixed));
    all.bm.push_back(squares(outputs.b, mixed));
  }
  return all;
}

double sum(const std::vector<double>& values, const std::vector<std::size_t>& chosen) {
  double total = 0;
  for (const std::size_t i : chosen) total += values[i];
  return total;
}

struct Estimate {
  double first = 0, total = 0;
};

/// By group, of the chosen pairs; empty where their outputs do not vary.
std::vector<Estimate> estimate(const Squares& all, const std::vector<std::size_t>& chosen) {
  const double whole = sum(all.ab, chosen);
  if (!(whole > 0)) return {};
  std::vector<Estimate> groups;
  for (std::size_t g = 0; g < all.am.size(); ++g)
    groups.push_back({1 - sum(all.bm[g], chosen) / whole, sum(all.am[g], chosen) / whole});
  return groups;
}

SobolIndex with_interval(double value, const std::vector<double>& resampled, double level) {
  return {value, quantile(resampled, 0.5 * (1 - level)), quantile(resampled, 0.5 * (1 + level))};
}

}  // namespace

std::vector<GroupShare> sobol_indices(const PickFreeze& outputs, const Bootstrap& bootstrap) {
  const Squares all = squares_of(outputs);
  const std::size_t pairs = all.ab.size();
  UNDERSTUDY_ASSERT(pairs >= 2, "one pair has no variance");
  std::vector<std::size_t> chosen(pairs);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const std::vector<Estimate> found = estimate(all, chosen);
  std::vector<std::vector<double>> first(found.size()), total(found.size());
  Random random(bootstrap.seed, "sobol bootstrap");
  for (int r = 0; r < bootstrap.resamples; ++r) {
    for (std::size_t& i : chosen)
      i = static_cast<std::size_t>(std::floor(random.uniform() * static_cast<double>(pairs)));
    const std::vector<Estimate> again = estimate(all, chosen);
    for (std::size_t g = 0; g < again.size(); ++g) {
      first[g].push_back(again[g].first);
      total[g].push_back(again[g].total);
    }
  }
  std::vector<GroupShare> shares;
  for (std::size_t g = 0; g < found.size(); ++g)
    shares.push_back({with_interval(found[g].first, first[g], bootstrap.level),
                      with_interval(found[g].total, total[g], bootstrap.level)});
  return shares;
}

}  // namespace understudy::studies

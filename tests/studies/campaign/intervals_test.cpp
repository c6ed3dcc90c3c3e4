#include "studies/campaign/intervals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/quantile.h"
#include "core/random.h"

namespace understudy::studies {
namespace {

/// Share of binomial(n, p) at or below k, summed term by term.
double at_most(int k, int n, double p) {
  double sum = 0;
  for (int i = 0; i <= k; ++i)
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  return sum;
}

TEST(BinomialInterval, EndsWhereTheTailsHoldHalfOfWhatIsLeft) {
  // Clopper and Pearson's definition, against sums of the binomial distribution. 1e-9: rounding of these
  // sums.
  for (const auto& [k, n] : std::vector<std::pair<int, int>>{{1, 10}, {7, 20}, {190, 200}, {50, 100}}) {
    const Interval interval =
        binomial_interval(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(n), 0.95);
    EXPECT_DOUBLE_EQ(interval.value, static_cast<double>(k) / n);
    EXPECT_NEAR(1 - at_most(k - 1, n, interval.low), 0.025, 1e-9) << k << " of " << n;
    EXPECT_NEAR(at_most(k, n, interval.high), 0.025, 1e-9) << k << " of " << n;
  }
}

TEST(BinomialInterval, OfNoneOrAllEndsAtTheEnd) {
  // (1 - p)^n = 0.025 in closed form.
  const Interval none = binomial_interval(0, 30, 0.95), all = binomial_interval(30, 30, 0.95);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 1 - std::pow(0.025, 1.0 / 30), 1e-12);
  EXPECT_NEAR(all.low, std::pow(0.025, 1.0 / 30), 1e-12);
  EXPECT_EQ(all.high, 1);
}

TEST(BinomialInterval, OfNoRunsIsEverything) {
  const Interval interval = binomial_interval(0, 0, 0.95);
  EXPECT_EQ(interval.low, 0);
  EXPECT_EQ(interval.high, 1);
}

TEST(BinomialInterval, HoldsTheTruthAsOftenAsItSays) {
  constexpr int kTrials = 2000, kRuns = 40;
  for (const double p : {0.03, 0.5, 0.9}) {
    Random random(7, "coverage");
    int held = 0;
    for (int t = 0; t < kTrials; ++t) {
      std::uint64_t count = 0;
      for (int i = 0; i < kRuns; ++i) count += random.uniform() < p ? 1 : 0;
      const Interval interval = binomial_interval(count, kRuns, 0.9);
      held += interval.low <= p && p <= interval.high ? 1 : 0;
    }
    // Exact intervals hold at least 90 %; three sigma of 2000 trials are 2 %.
    EXPECT_GT(held, 0.88 * kTrials) << p;
  }
}

TEST(QuantileInterval, EqualsABootstrapThatDrawsEveryValue) {
  Random random(3, "values");
  std::vector<double> values(60);
  for (double& v : values) v = random.normal();
  for (const double share : {0.05, 0.5, 0.95}) {
    std::vector<double> resampled;
    for (int b = 0; b < 4000; ++b) {
      std::vector<double> one(values.size());
      for (double& v : one) v = values[random.bits() % values.size()];
      resampled.push_back(quantile(one, share));
    }
    const Interval interval = quantile_interval(values, share, 0.95, "test");
    EXPECT_DOUBLE_EQ(interval.value, quantile(values, share));
    // The ends are percentiles of 1000 and 4000 draws: values near them lie some 0.1 sigma apart.
    EXPECT_NEAR(interval.low, quantile(resampled, 0.025), 0.15) << share;
    EXPECT_NEAR(interval.high, quantile(resampled, 0.975), 0.15) << share;
  }
}

TEST(QuantileInterval, DoesNotDependOnTheOrderOfTheValues) {
  std::vector<double> values{3, 1, 4, 1, 5, 9, 2, 6};
  const Interval one = quantile_interval(values, 0.5, 0.9, "x");
  std::reverse(values.begin(), values.end());
  const Interval other = quantile_interval(values, 0.5, 0.9, "x");
  EXPECT_EQ(one.low, other.low);
  EXPECT_EQ(one.high, other.high);
}

TEST(QuantileInterval, OfNothingIsNothing) {
  EXPECT_TRUE(std::isnan(quantile_interval({}, 0.5, 0.9, "x").value));
  const Interval one = quantile_interval({2}, 0.95, 0.9, "x");
  EXPECT_EQ(one.low, 2);
  EXPECT_EQ(one.high, 2);
}

}  // namespace
}  // namespace understudy::studies

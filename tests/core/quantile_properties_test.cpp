#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/quantile.h"
#include "tests/property.h"

namespace understudy {
namespace {

using property::real;
using property::whole;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Some of them equal, some infinite: a gap over nothing is.
std::vector<double> drawn_values() {
  std::vector<double> values;
  for (int n = *rc::gen::inRange(1, 40); n > 0; --n) {
    const int kind = *whole(0, 9);
    values.push_back(kind == 0 ? kInfinity : kind < 4 ? *whole(-3, 3) : *real(-1, 1));
  }
  return values;
}

TEST(QuantileProperties, AtTheRankOfAnOrderStatisticItIsThatOne) {
  property::check({2000, 60}, [] {
    const std::vector<double> values = drawn_values();
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    RC_ASSERT(quantile(values, 0) == sorted.front());
    RC_ASSERT(quantile(values, 1) == sorted.back());
    if (values.size() % 2 == 1) RC_ASSERT(quantile(values, 0.5) == sorted[values.size() / 2]);
    // A power of two of steps makes shares without rounding.
    if (values.size() == 5 || values.size() == 9 || values.size() == 17)
      for (std::size_t k = 0; k < sorted.size(); ++k)
        RC_ASSERT(quantile(values, static_cast<double>(k) / static_cast<double>(sorted.size() - 1)) ==
                  sorted[k]);
  });
}

TEST(QuantileProperties, ItRisesWithTheShareAndLiesBetweenItsNeighbours) {
  property::check({2000, 60}, [] {
    std::vector<double> values = drawn_values();
    const double low = *real(0, 1), high = *real(low, 1);
    const double at_low = quantile(values, low), at_high = quantile(values, high);
    RC_ASSERT(at_low <= at_high + 1e-15);
    std::rotate(values.begin(), values.begin() + *whole(0, static_cast<int>(values.size()) - 1),
                values.end());
    RC_ASSERT(quantile(values, low) == at_low);
    std::sort(values.begin(), values.end());
    const double rank = low * static_cast<double>(values.size() - 1);
    RC_ASSERT(at_low >= values[static_cast<std::size_t>(std::floor(rank))] - 1e-15);
    RC_ASSERT(at_low <= values[static_cast<std::size_t>(std::ceil(rank))] + 1e-15);
  });
}

}  // namespace
}  // namespace understudy

#include "core/quantile.h"

#include <cmath>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Quantile, LiesOnTheLineBetweenNeighboursInOrder) {
  EXPECT_EQ(quantile({40, 10, 30, 20}, 0.5), 25);
  EXPECT_EQ(quantile({40, 10, 30, 20, 50}, 0.5), 30);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.25), 2.5);
}

TEST(Quantile, EndsAtTheExtremes) {
  EXPECT_EQ(quantile({3, 1, 2}, 0), 1);
  EXPECT_EQ(quantile({3, 1, 2}, 1), 3);
  EXPECT_EQ(quantile({7}, 0.3), 7);
}

TEST(Quantile, OfNothingIsNoNumber) { EXPECT_TRUE(std::isnan(quantile({}, 0.5))); }

}  // namespace
}  // namespace understudy

#include "core/random.h"

#include <bit>
#include <set>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(RandomSource, EqualSeedAndPurposeGiveEqualNumbers) {
  Random a(7, "x"), b(7, "x"), other_seed(8, "x"), other_purpose(7, "y");
  for (int i = 0; i < 100; ++i) {
    const auto bits = a.bits();
    EXPECT_EQ(bits, b.bits());
    EXPECT_NE(bits, other_seed.bits());
    EXPECT_NE(bits, other_purpose.bits());
  }
}

// 1e6 draws: the mean of a standard normal has sigma 1e-3, its variance sqrt(2)*1e-3, its fourth moment
// sqrt(96)*1e-3; five sigma.
TEST(RandomSource, NormalHasTheMomentsOfAStandardNormal) {
  Random random(1, "moments");
  double sum = 0, sum2 = 0, sum4 = 0;
  constexpr int kDraws = 1000000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 5e-3);
  EXPECT_NEAR(sum2 / kDraws, 1, 7.1e-3);
  EXPECT_NEAR(sum4 / kDraws, 3, 49e-3);
}

TEST(RandomSource, UniformStaysInsideItsInterval) {
  Random random(3, "uniform");
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform(-2, 5);
    ASSERT_GE(x, -2);
    ASSERT_LT(x, 5);
  }
}

TEST(RandomSource, HashOfNeighbouringCountersDoesNotCollideAndIsBalanced) {
  std::set<std::uint64_t> seen;
  int ones = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const auto h = hash_bits(42, i);
    seen.insert(h);
    ones += std::popcount(h);
  }
  EXPECT_EQ(seen.size(), 100000u);
  // 6.4e6 fair bits: sigma 1265.
  EXPECT_NEAR(ones, 3200000, 5 * 1265);
}

}  // namespace
}  // namespace understudy

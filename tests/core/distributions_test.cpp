// Against printed tables (NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.1 and 1.3.6.7.4).
#include "core/distributions.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Distributions, ChiSquaredAsInTables) {
  EXPECT_NEAR(chi_squared_exceeded(1, 0.05), 3.841, 5e-4);
  EXPECT_NEAR(chi_squared_exceeded(10, 0.01), 23.209, 5e-4);
  EXPECT_NEAR(chi_squared_exceeded(100, 0.001), 149.449, 5e-4);
}

TEST(Distributions, NormalAsInTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 1e-6);
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-15);
  EXPECT_NEAR(normal_below(1), 0.84134, 5e-6);
  EXPECT_NEAR(normal_below(-2.5), 0.00621, 5e-6);
}

}  // namespace
}  // namespace understudy

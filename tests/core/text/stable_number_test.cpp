#include "core/text/stable_number.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(StableNumber, KeepsSoManyDigits) {
  EXPECT_EQ(stable_number(88.123456, "x"), 88.1235);
  EXPECT_EQ(stable_number(88.123456, "x", 3), 88.1);
  EXPECT_EQ(stable_number(-1.23456789e-20, "x"), -1.23457e-20);
}

TEST(StableNumber, DoesNotHangOnTheLastBit) {
  EXPECT_EQ(stable_number(std::nextafter(88.123456, 100.0), "x"), stable_number(88.123456, "x"));
}

TEST(StableNumber, HasNoNegativeZero) { EXPECT_FALSE(std::signbit(stable_number(-0.0, "x"))); }

TEST(StableNumber, ANumberThatIsNotFiniteIsOurOwnMistake) {
  EXPECT_THROW(stable_number(std::numeric_limits<double>::quiet_NaN(), "x"), std::logic_error);
  EXPECT_THROW(stable_number(std::numeric_limits<double>::infinity(), "x"), std::logic_error);
}

}  // namespace
}  // namespace understudy

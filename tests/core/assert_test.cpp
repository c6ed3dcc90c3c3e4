#include "core/assert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace understudy {
namespace {

TEST(Assertion, NamesConditionPlaceAndReason) {
  const int struts = 5;
  try {
    UNDERSTUDY_ASSERT(struts == 6, "a hexapod has six struts");
    FAIL() << "nothing was thrown";
  } catch (const std::logic_error& mistake) {
    EXPECT_THAT(mistake.what(), testing::HasSubstr("assert_test.cpp:"));
    EXPECT_THAT(mistake.what(), testing::HasSubstr("struts == 6 does not hold: a hexapod has six struts"));
  }
}

TEST(Assertion, LetsPassWhatHolds) { EXPECT_NO_THROW(UNDERSTUDY_ASSERT(1 + 1 == 2, "arithmetic")); }

}  // namespace
}  // namespace understudy

#include "core/text/trimmed.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Trimmed, TakesBlanksFromBothEndsAndLeavesThoseBetween) {
  EXPECT_EQ(trimmed(" \t two  words\r\n"), "two  words");
  EXPECT_EQ(trimmed("as it is"), "as it is");
  EXPECT_EQ(trimmed(" \r\n\t "), "");
  EXPECT_EQ(trimmed(""), "");
}

}  // namespace
}  // namespace understudy

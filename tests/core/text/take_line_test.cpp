#include "core/text/take_line.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(TakeLine, EndsAtEachKindOfLineEnd) {
  std::string_view rest = "a\r\nb\rc\nd";
  EXPECT_EQ(take_line(rest), "a");
  EXPECT_EQ(take_line(rest), "b");
  EXPECT_EQ(take_line(rest), "c");
  EXPECT_EQ(take_line(rest), "d");
  EXPECT_TRUE(rest.empty());
}

}  // namespace
}  // namespace understudy

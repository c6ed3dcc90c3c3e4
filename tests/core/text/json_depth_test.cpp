#include "core/text/json_depth.h"

#include <string>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(JsonDepth, CountsWhatIsOpenAtOnce) {
  EXPECT_FALSE(nests_deeper("[[]]", 2));
  EXPECT_TRUE(nests_deeper("[[{}]]", 2));
  EXPECT_FALSE(nests_deeper("[[],[],[],{},{}]", 2));
  EXPECT_TRUE(nests_deeper(std::string(200'000, '[')));
}

TEST(JsonDepth, BracketsInTextDoNotCount) {
  EXPECT_FALSE(nests_deeper(R"(["[[[[", "\"[[[[", {"{{{{\\": 1}])", 2));
  EXPECT_TRUE(nests_deeper(R"(["[\\", [[]]])", 2));
}

}  // namespace
}  // namespace understudy

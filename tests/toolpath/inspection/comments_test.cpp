#include "toolpath/inspection/comments.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

// A lone carriage return ends a line for the reader, too: what comments say of lines is of its lines.
TEST(Comments, ComeWithTheNumberThatTheReaderGivesTheirLine) {
  std::vector<std::pair<int, std::string>> found;
  for_each_comment("G28\r\r\n ; a \nG1 X1 ; behind words\n;b",
                   [&](int line, std::string_view comment) { found.emplace_back(line, comment); });
  EXPECT_THAT(found, ElementsAre(Pair(3, "a"), Pair(5, "b")));
}

}  // namespace
}  // namespace understudy::toolpath

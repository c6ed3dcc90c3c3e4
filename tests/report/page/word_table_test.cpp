#include "report/page/word_table.h"

#include <gtest/gtest.h>

namespace understudy::report {
namespace {

const WordTable kTable{
    "A <title>", "note", {"name", "count", "stops"}, 1, {{"a", "7", "2 dark"}, {"long", "123", ""}}};

TEST(WordTable, AlignsWordsLeftAndNumbersRight) {
  EXPECT_EQ(plain_text(kTable),
            "A <title>\n"
            "name  count  stops\n"
            "a         7  2 dark\n"
            "long    123\n");
}

TEST(WordTable, IsTextInAPage) {
  const std::string html = html_section(kTable);
  EXPECT_NE(html.find("<h2>A &lt;title&gt;</h2>"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"number\">123</td>"), std::string::npos);
  EXPECT_NE(html.find("<td>2 dark</td>"), std::string::npos);
}

}  // namespace
}  // namespace understudy::report

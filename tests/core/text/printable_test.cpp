#include "core/text/printable.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  EXPECT_EQ(printable("strut 3 is 241.7 mm"), "strut 3 is 241.7 mm");
  EXPECT_EQ(printable("D\xc3\xbcse 0,4 \xc2\xb5m \xe2\x82\xac \xf0\x9f\x94\xa7"),
            "D\xc3\xbcse 0,4 \xc2\xb5m \xe2\x82\xac \xf0\x9f\x94\xa7");
}

TEST(Printable, NoTextMovesTheCursorOrBreaksTheLine) {
  EXPECT_EQ(printable("\x1b[2J\x1b[31mx"), "\\x1b[2J\\x1b[31mx");
  EXPECT_EQ(printable("a\nb\tc\rd\x7f"), "a\\nb\\tc\\x0dd\\x7f");
  EXPECT_EQ(printable("\xc2\x9b\x32J"), "\\xc2\\x9b2J") << "C1: a control sequence in one character";
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

TEST(Printable, BytesThatAreNoTextAreNumbers) {
  EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(printable("\xe2\x82z"), "\\xe2\\x82z");
}

TEST(Printable, TheMiddleOfALongTextGoes) {
  const std::string cut = printable("begin" + std::string(10'000'000, 'x') + "end", 20);
  EXPECT_EQ(cut, "beginxxxxx ... xxxxxxxend");
  EXPECT_EQ(printable("\xc3\xbc\xc3\xbc\xc3\xbc\xc3\xbc", 5), "\xc3\xbc ... \xc3\xbc")
      << "no half characters";
}

}  // namespace
}  // namespace understudy

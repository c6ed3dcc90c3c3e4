#include "core/file/number_table.h"

#include <sstream>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy {
namespace {

std::vector<NumberRow> read(const std::string& text) {
  std::istringstream in(text);
  return read_number_table(in, "t.csv", {"a", "b"});
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(NumberTable, ReadsRowsWithTheirLines) {
  const auto rows = read("# made by hand\na, b\r\n+1,-2.5e-3\n\n3 , 4\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].line, 3);
  EXPECT_EQ(rows[0].values, (std::vector<double>{1, -2.5e-3}));
  EXPECT_EQ(rows[1].line, 5);
  EXPECT_EQ(rows[1].values, (std::vector<double>{3, 4}));
}

TEST(NumberTable, NamesPlaceAndValueOfWhatIsWrong) {
  EXPECT_EQ(refusal(""), "t.csv: is empty; the header is 'a,b'");
  EXPECT_EQ(refusal("a,c\n1,2\n"), "t.csv:1: the header is 'a,c', not 'a,b'");
  EXPECT_EQ(refusal("a,b\n1,2\n1\n"), "t.csv:3: 1 cells, not 2");
  EXPECT_EQ(refusal("a,b\n1,x\n"), "t.csv:2:3: b is 'x', not a finite number");
  EXPECT_EQ(refusal("a,b\nnan,1\n"), "t.csv:2:1: a is 'nan', not a finite number");
  EXPECT_EQ(refusal("a,b\n1,1e999\n"), "t.csv:2:3: b is '1e999', not a finite number");
}

}  // namespace
}  // namespace understudy

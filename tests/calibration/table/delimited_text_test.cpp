#include "calibration/table/delimited_text.h"

#include <gmock/gmock.h>

#include "core/error.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

std::string refused(const std::string& text, const TextFormat& format = {}, const std::string& column = "") {
  try {
    const DelimitedText table(text, "t.csv", format);
    if (!column.empty()) table.number(0, table.column(column));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DelimitedText, FindsSeparatorHeaderAndDecimals) {
  const DelimitedText comma("\xef\xbb\xbfx;y z;n\r\n1,5;-2,0E+1;A\r\n3;4;B\r\n", "t.csv", {});
  EXPECT_EQ(comma.rows(), 2u);
  EXPECT_EQ(comma.number(0, comma.column("x")), 1.5);
  EXPECT_EQ(comma.number(0, comma.column("Y Z")), -20);
  EXPECT_EQ(comma.text(1, comma.column("n")), "B");
  const DelimitedText plain("# log\n1.5 2 3\n\n4 5 6\n", "t.txt", {});
  EXPECT_TRUE(plain.header().empty());
  EXPECT_EQ(plain.number(1, plain.column("3")), 6);
  EXPECT_EQ(plain.line(1), 4);
  const DelimitedText english("x,y\n1.5,2\n", "t.csv", {});
  EXPECT_EQ(english.number(0, 0), 1.5);
  const DelimitedText spaced("0,5 1,25\n1,5 2,25\n", "t.txt", {});
  EXPECT_EQ(spaced.number(1, 1), 2.25);
  const DelimitedText quoted("\"x, mm\",y\n1,2\n", "t.csv", {});
  EXPECT_EQ(quoted.number(0, quoted.column("x, mm")), 1);
}

TEST(DelimitedText, FindsColumnsWithoutTheirUnitsAndASeparatorThatIsTold) {
  const DelimitedText leica("X  [mm],U(95) X  [mm],U(95)  [mm]\n1,2,3\n", "t.csv", {});
  EXPECT_EQ(leica.column("x"), 0u);
  EXPECT_EQ(leica.column("U(95) X"), 1u);
  EXPECT_EQ(leica.column("U(95)"), 2u);
  EXPECT_EQ(leica.column("X [mm]"), 0u);
  const DelimitedText told("sep=|\na|b\n1|2\n", "t.csv", {});
  EXPECT_EQ(told.number(0, told.column("b")), 2);
  EXPECT_EQ(told.line(0), 3);
  const DelimitedText points("p1, 1.5, x\np2, 2.5, y\n", "t.txt", {});
  EXPECT_EQ(points.rows(), 2u);
  EXPECT_THAT(refused("X [mm],x [deg]\n1,2\n", {}, "X"), HasSubstr("there twice"));
  EXPECT_THAT(refused(std::string("\xff\xfe"
                                  "1\0",
                                  4)),
              HasSubstr("is UTF-16: save it as plain text"));
}

TEST(DelimitedText, NamesWhatItCannotRead) {
  EXPECT_THAT(refused("x;y\n1,5;2\n1.5;3\n"), HasSubstr("some numbers have a comma and some a point"));
  EXPECT_THAT(refused("x;y\n1;2\n3\n"), HasSubstr("t.csv:3: 1 cells, where the first line has 2"));
  EXPECT_THAT(refused("x,y\n1,two\n", {}, "y"), HasSubstr("t.csv:2: 'y' is 'two', not a finite number"));
  EXPECT_THAT(refused("length,y\n1,2\n", {}, "lenght"), HasSubstr("did you mean 'length'"));
  EXPECT_THAT(refused("1,2\n3,4\n", {}, "3"), HasSubstr("there is no column 3, only 2"));
  EXPECT_THAT(refused("1,2\n3,4\n", {}, "x"), HasSubstr("no header"));
  EXPECT_THAT(refused("x,x\n3,4\n", {}, "x"), HasSubstr("there twice"));
  EXPECT_THAT(refused("x,y\nnan,4\n", {}, "x"), HasSubstr("not a finite number"));
  EXPECT_THAT(refused("# nothing\n"), HasSubstr("no rows"));
}

}  // namespace
}  // namespace understudy::calibration

#include "toolpath/planners/curve_csv.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

class CurveCsv : public ::testing::Test {
 protected:
  std::vector<Vec3> read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_curve_csv(path_);
  }
  std::string rejection(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.string().size());
    }
    return "accepted";
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "curve.csv";
};

TEST_F(CurveCsv, GivesMetres) {
  const auto curve = read("x_mm,y_mm,z_mm\r\n1,-2.5,+3e1\r\n\r\n 4 , 5 ,6");
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_LT((curve[0] - Vec3(1e-3, -2.5e-3, 30e-3)).norm(), 1e-15);
  EXPECT_LT((curve[1] - Vec3(4e-3, 5e-3, 6e-3)).norm(), 1e-15);
}

TEST_F(CurveCsv, NamesLineAndColumnOfWhatIsWrong) {
  EXPECT_EQ(rejection(""), ": is empty; the header is 'x_mm,y_mm,z_mm'");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n"), ": 1 points, a curve needs 2");
  EXPECT_EQ(rejection("x,y,z\n1,2,3\n"), ":1: the header is 'x,y,z', not 'x_mm,y_mm,z_mm'");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n1,2\n"), ":3: 2 cells, not 3");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3,4\n"), ":2: 4 cells, not 3");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n\n1,two,3\n"), ":4:3: y_mm is 'two', not a finite number");
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n1,2,nan\n"), HasSubstr("z_mm is 'nan'"));
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n1e999,2,3\n"), HasSubstr("x_mm is '1e999'"));
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n,2,3\n"), HasSubstr("x_mm is ''"));
}

}  // namespace
}  // namespace understudy::toolpath

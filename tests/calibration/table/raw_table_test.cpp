#include "calibration/table/raw_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "calibration/table/measured_rows.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/complaint.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RawTableTest : public ::testing::Test {
 protected:
  RawTable read(const std::string& csv) {
    write_file(folder_ / "rows.csv", csv);
    std::string bytes;
    return read_raw(map_, folder_ / "rows.csv", "rows", "", bytes);
  }
  std::string error(const std::string& csv) {
    try {
      read(csv);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  RawTableTest() {
    map_.kind = RowKind::position;
    map_.joints.columns = {"j1", "j2"};
    map_.joint_unit_told = true;
    map_.joints.unit = kDegree;
    map_.position = {{"x", "y", "z"}, kMillimetre, true, {"s"}, kMillimetre};
    map_.frame = "tracker";
    map_.target = "r";
  }

  TemporaryFolder folder_;
  TableMap map_;
};

TEST_F(RawTableTest, RowsWithoutAMeasurementAreLeftOutAndNamed) {
  const RawTable raw =
      read("x,y,z,s,j1,j2\n1,2,3,0.1,10,20\nnan,nan,nan,0.1,11,21\n4,,6,0.1,12,22\n7,8,9,0.1,13,23\n");
  EXPECT_THAT(raw.lines, ElementsAre(2, 5));
  EXPECT_THAT(raw.joints, ElementsAre(ElementsAre(10, 20), ElementsAre(13, 23)));
  EXPECT_THAT(raw.position, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(7, 8, 9)));
  ASSERT_EQ(raw.notes.size(), 1u);
  EXPECT_THAT(raw.notes[0], HasSubstr("2 rows without a measurement were left out: lines 3, 4"));
  EXPECT_THAT(error("x,y,z,s,j1,j2\nnan,1,2,0.1,10,20\n"), HasSubstr("no row has all"));
  EXPECT_THAT(error("x,y,z,s,j1,j2\n1,2,3,0.1,nan,20\n"), HasSubstr("'j1' is 'nan'"));
}

TEST_F(RawTableTest, ASigmaOfZeroIsTheLeastOfTheOthers) {
  const RawTable raw = read("x,y,z,s,j1,j2\n1,2,3,0.02,10,20\n1,2,3,0,11,21\n1,2,3,0.01,12,22\n");
  EXPECT_THAT(raw.sigma_position, ElementsAre(ElementsAre(0.02), ElementsAre(0.01), ElementsAre(0.01)));
  ASSERT_EQ(raw.notes.size(), 1u);
  EXPECT_THAT(raw.notes[0], HasSubstr("sigmas of 0 are taken as 0.01, the least of the others: lines 3"));
  EXPECT_THAT(error("x,y,z,s,j1,j2\n1,2,3,-0.1,10,20\n"), HasSubstr(":2: a sigma is -0.1"));
}

// Its square would be infinite, or none.
TEST_F(RawTableTest, ASigmaThatNoDeviceHasIsRefusedWithItsLine) {
  map_.joints.columns = std::vector<std::string>(6, "j1");
  const auto machine = machine::load_machine("arm");
  const auto error_of = [&](const std::string& sigma) {
    return complaint([&] { rows_of(read("x,y,z,s,j1\n1,2,3,0.1,10\n1,2,3," + sigma + ",11\n"), machine); });
  };
  EXPECT_EQ(error_of("1000"), "accepted");
  for (const std::string sigma : {"1001", "1e200", "1e-10", "1e-200"})
    EXPECT_THAT(error_of(sigma), HasSubstr("rows.csv:3: a sigma is ")) << sigma;
}

TEST_F(RawTableTest, SignsAndOffsetsMakeTheMachinesReadings) {
  map_.joints.columns = {"j1", "j2", "j1", "j1", "j1", "j1"};
  map_.joint_signs = {1, -1, 1, 1, 1, 1};
  map_.joint_offsets = {0, 90, 0, 0, 0, 0};
  const auto rows = rows_of(read("x,y,z,s,j1,j2\n1,2,3,0.1,10,20\n"), machine::load_machine("arm"));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0].axes[0], 10 * kDegree, 1e-15);
  EXPECT_NEAR(rows[0].axes[1], 70 * kDegree, 1e-15);
}

// A camera on the tool sees a board: its pose is that of the frame, seen from the target.
TEST_F(RawTableTest, APoseSeenFromTheTargetIsTurnedAboutWithItsNoise) {
  map_.kind = RowKind::pose;
  map_.joints.columns = std::vector<std::string>(6, "j1");
  map_.position = {{"x", "y", "z"}, kMillimetre, true, {}, kMillimetre};
  map_.orientation = {{"qw", "qx", "qy", "qz"}, 1, true, {}, 1e-3};
  map_.inverse = true;
  map_.sigma_position = 1e-4;
  map_.sigma_turn = 1e-3;
  // A quarter turn about z, 500 mm away along z.
  const auto rows =
      rows_of(read("x,y,z,qw,qx,qy,qz,j1\n0,100,500,0.70710678118654752,0,0,0.70710678118654752,10\n"),
              machine::load_machine("arm"));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_LT((rows[0].X_MG.translation() - Vec3(-0.1, 0, -0.5)).norm(), 1e-12);
  EXPECT_LT((rows[0].X_MG.linear() * Vec3::UnitX() - Vec3(0, -1, 0)).norm(), 1e-12);
  // Across the line of sight a turn of 1 mrad moves the camera by 0.5 mm.
  const Mat6& covariance = rows[0].covariance;
  EXPECT_NEAR(covariance(1, 1), 1e-8 + 0.26e-6, 1e-12);
  EXPECT_NEAR(covariance(2, 2), 1e-8 + 0.01e-6, 1e-12);
  EXPECT_NEAR(covariance(3, 3), 1e-6, 1e-12);
}

TEST_F(RawTableTest, ASpreadsheetIsToldToBeExported) {
  EXPECT_THAT(error(std::string("PK\x03\x04", 4) + "x"), HasSubstr("export the table as CSV"));
}

}  // namespace
}  // namespace understudy::calibration

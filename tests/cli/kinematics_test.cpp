#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/number_table.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kPoseHeader = "x_mm,y_mm,z_mm,qw,qx,qy,qz\n";

TEST(Axes, HomeOfTheNominalMachine) {
  const Folder folder;
  const auto poses = folder.write("poses.csv", kPoseHeader + "0,0,50,1,0,0,0\n");
  const Outcome outcome = understudy("axes --machine hexapod <" + poses);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // docs/reference.md#machine-g4: 189.2924 mm from joint to joint; the screw runs 15 mm beside the base
  // joint: sqrt(189.29235^2 - 15^2) = 188.69709.
  EXPECT_THAT(outcome.out, StartsWith("l1_mm,l2_mm,l3_mm,l4_mm,l5_mm,l6_mm,status\n188.697"));
  EXPECT_THAT(outcome.out, HasSubstr(",ok\n"));
}

TEST(Axes, PosesInvertsAxes) {
  const Folder folder;
  const auto poses = folder.write("poses.csv", kPoseHeader + "3,-4,45,0.99619469809,0.08715574275,0,0\n");
  const Outcome axes = understudy("axes <" + poses);
  ASSERT_EQ(axes.status, 0) << axes.err;
  std::string table = axes.out;
  for (std::size_t at = table.find(",status"); at != std::string::npos; at = table.find(",status"))
    table.erase(at, 7);
  for (std::size_t at = table.find(",ok"); at != std::string::npos; at = table.find(",ok"))
    table.erase(at, 3);
  const Outcome back = understudy("poses <" + folder.write("axes.csv", table));
  ASSERT_EQ(back.status, 0) << back.err;
  std::string numbers = back.out;
  for (std::size_t at = numbers.find(",status"); at != std::string::npos; at = numbers.find(",status"))
    numbers.erase(at, 7);
  for (std::size_t at = numbers.find(",ok"); at != std::string::npos; at = numbers.find(",ok"))
    numbers.erase(at, 3);
  std::istringstream in(numbers);
  const auto rows = read_number_table(in, "out", {"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"});
  ASSERT_EQ(rows.size(), 1u);
  // Axes are printed to 1 nm; the condition number of about 6 and the lever of 25 mm leave under 20 nm.
  EXPECT_NEAR(rows[0].values[0], 3, 2e-5);
  EXPECT_NEAR(rows[0].values[1], -4, 2e-5);
  EXPECT_NEAR(rows[0].values[2], 45, 2e-5);
  EXPECT_NEAR(rows[0].values[4], 0.08715574275, 1e-6);
}

TEST(Axes, ARowWithoutSolutionPrintsNanAndTheReason) {
  const Folder folder;
  const auto poses = folder.write("poses.csv", kPoseHeader + "0,0,150,1,0,0,0\n0,0,50,1,0,0,0\n");
  const Outcome outcome = understudy("axes <" + poses);
  ASSERT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("nan,nan,nan,nan,nan,nan,strut "));
  EXPECT_THAT(outcome.out, HasSubstr("ok\n"));
}

// Stretched out along x: 380 + 340 mm from the base, the wrist beside it by the sums of arm.urdf's origins.
TEST(Poses, ASingularPostureHasItsPoseAndTheReason) {
  const Folder folder;
  const std::string rows =
      folder.write("rows.csv", "j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\n0,0,0,0,0,0\n0,0,200,0,0,0\n");
  const Outcome outcome = understudy("poses --machine offset-wrist-arm < " + rows);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("370.000000,300.000000,-90.000000,"));
  EXPECT_THAT(outcome.out, HasSubstr(",tool pose has condition number"));
  EXPECT_THAT(outcome.out, HasSubstr("nan,nan,nan,nan,nan,nan,nan,axis j3 is at 200.0 deg"));
}

TEST(Axes, BadRowsAreRefusedWithTheirPlace) {
  const Folder folder;
  const Outcome number = understudy("axes <" + folder.write("a.csv", kPoseHeader + "0,0,x,1,0,0,0\n"));
  EXPECT_EQ(number.status, 2);
  EXPECT_THAT(number.err, HasSubstr("standard input:2:5"));
  const Outcome unit = understudy("axes <" + folder.write("b.csv", kPoseHeader + "0,0,50,0.9,0,0,0\n"));
  EXPECT_EQ(unit.status, 2);
  EXPECT_THAT(unit.err, HasSubstr("0.9"));
  const Outcome header = understudy("poses <" + folder.write("c.csv", "l1,l2\n1,2\n"));
  EXPECT_EQ(header.status, 2);
  EXPECT_THAT(header.err, HasSubstr("l1_mm"));
}

}  // namespace
}  // namespace understudy::cli_test

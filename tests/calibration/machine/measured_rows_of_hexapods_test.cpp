// A hexapod from a tracker's table, as its user has it.
#include "calibration/machine/calibrate_measured_rows.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/calibration/rows/drawn_rows.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

class TrackedHexapod : public ::testing::Test {
 protected:
  TrackedHexapod() {
    lab_.add_in_frame(RowKind::position, "left", make_pose(Mat3(Mat3::Identity()), {-0.05, 0.02, 0.03}), 60);
    lab_.add_in_frame(RowKind::position, "right", make_pose(Mat3(Mat3::Identity()), {0.06, 0.03, 0.02}), 60);
    request_.machine = "hexapod";
    write_file(folder_ / "map.yaml",
               "kind: position\njoints: {columns: [l1, l2, l3, l4, l5, l6]}\nposition: {columns: [X, Y, Z]}\n"
               "frame: tracker\ntarget_column: Target\n");
    request_.map = read_column_map(folder_ / "map.yaml");
  }

  std::string table(const std::string& name, std::size_t first, std::size_t step) {
    std::string text = "X [mm],Y [mm],Z [mm],l1 [mm],l2 [mm],l3 [mm],l4 [mm],l5 [mm],l6 [mm],Target\n";
    for (std::size_t j = first; j < lab_.problem.rows.size(); j += step) {
      const MeasurementRow& row = lab_.problem.rows[j];
      const Vec3 p = 1e3 * row.X_MG.translation();
      text += fmt::format("{},{},{}", p.x(), p.y(), p.z());
      for (const double length : row.axes) text += fmt::format(",{}", 1e3 * length);
      text += "," + row.target + "\n";
    }
    write_file(folder_ / name, text);
    return folder_ / name;
  }

  TemporaryFolder folder_;
  DrawnRows lab_{DrawnRows({}, 1, "hexapod").nominal.free_parameters(true, true), 6, "hexapod"};
  RowsRequest request_;
};

TEST_F(TrackedHexapod, MeetsRowsThatWereHeldOutByTheirNoise) {
  request_.compared = {table("others.csv", 2, 3)};
  std::string fitted = table("a.csv", 0, 3);
  request_.measurements = {fitted, table("b.csv", 1, 3)};
  const MachineCalibration found = calibrate_measured_rows(request_);
  EXPECT_EQ(found.parameters.size(), 30u);
  EXPECT_EQ(found.redundant.size(), 12u);
  EXPECT_THAT(found.spoiled, ::testing::IsEmpty());
  ASSERT_EQ(found.compared.size(), 1u);
  // 40 rows of three numbers: 1 sigma of an RMS is 6 %; the parameters add their own.
  EXPECT_NEAR(found.compared[0].after, std::sqrt(3) * kDrawnSigma, 0.4 * kDrawnSigma);
  EXPECT_GT(found.compared[0].before, 3 * found.compared[0].after);
  EXPECT_GT(found.tip.rms, 0);
  // About the drawn base joints, which rows in the tracker's frame tell ten times worse than tips beside
  // tips.
  EXPECT_LT(found.tip.rms, 3e-3);
  for (const ParameterLine& line : found.parameters)
    if (line.name == "length offset 2") {
      EXPECT_NEAR(line.before, 1e3 * lab_.nominal.hexapod()->geometry.length_offset[1], 1e-9);
      EXPECT_NEAR(line.after, 1e3 * found.machine.hexapod().geometry.length_offset[1], 1e-9);
    }
}

TEST_F(TrackedHexapod, NamesASpoiledRowByFileAndLine) {
  lab_.problem.rows[16].X_MG.translation().x() += 5e-3;
  const std::string file = table("t.csv", 0, 1);
  request_.measurements = {file};
  const MachineCalibration found = calibrate_measured_rows(request_);
  ASSERT_EQ(found.spoiled.size(), 1u);
  EXPECT_EQ(found.spoiled[0].file, file);
  EXPECT_EQ(found.spoiled[0].line, 18);  // below the header
  EXPECT_EQ(found.spoiled[0].kind, "position");
  EXPECT_NEAR(found.spoiled[0].length, 5e-3, 0.5e-3);
  EXPECT_GT(found.spoiled[0].sigmas, 20);
  EXPECT_FALSE(found.poses[16].used);
  EXPECT_THAT(found.warnings, ::testing::Contains(HasSubstr("1 of 120 rows do not agree with the others")));
}

TEST_F(TrackedHexapod, AnotherMachineIsRefused) {
  request_.measurements = {table("t.csv", 0, 1)};
  request_.machine = "arm";
  try {
    (void)calibrate_measured_rows(request_);
    FAIL() << "an arm was calibrated by struts";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("t.csv"));
  }
}

}  // namespace
}  // namespace understudy::calibration

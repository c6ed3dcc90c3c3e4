#include "calibration/machine/compared_tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/calibration/rows/drawn_rows.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kMap =
    "kind: position\njoints: {columns: [j1, j2, j3, j4, j5, j6], unit: deg}\nposition: {columns: [x, y, z], "
    "unit: "
    "mm}\nframe: tracker\ntarget: r\nsigma_um: 50\n";

class ComparedTables : public ::testing::Test {
 protected:
  /// Rows of the reflector, with noise [m] beside that of the lab.
  std::string table(const std::string& name, int count, double noise = 0) {
    std::string text = "x,y,z,j1,j2,j3,j4,j5,j6\n";
    lab_.problem.rows.clear();
    lab_.add_in_frame(RowKind::position, "r", make_pose(Mat3::Identity(), {0.03, -0.04, 0.06}), count);
    for (const MeasurementRow& row : lab_.problem.rows) {
      const Vec3 p = 1e3 * (row.X_MG.translation() + lab_.noise(noise));
      text += fmt::format("{},{},{}", p.x(), p.y(), p.z());
      for (const double q : row.axes) text += fmt::format(",{}", q / kDegree);
      text += "\n";
    }
    write_file(folder_ / name, text);
    return folder_ / name;
  }
  MachineCalibration calibrated(const std::vector<std::string>& fitted,
                                const std::vector<std::string>& compared) {
    write_file(folder_ / "map.yaml", kMap);
    RowsRequest request;
    request.map = read_column_map(folder_ / "map.yaml");
    request.measurements = fitted;
    request.compared = compared;
    request.machine = "arm";
    return calibrate_measured_rows(request);
  }

  TemporaryFolder folder_;
  DrawnRows lab_{DrawnRows({}, 1).nominal.free_parameters(true, true), 4};
};

TEST_F(ComparedTables, EachFileHasItsFiguresAndOneThatGotWorseAWarning) {
  const std::string fitted = table("fitted.csv", 80), good = table("good.csv", 20),
                    far = table("far.csv", 20, 3e-3);
  const MachineCalibration found = calibrated({fitted}, {good, far});
  ASSERT_EQ(found.compared_files.size(), 2u);
  EXPECT_EQ(found.compared_files[0].file, good);
  EXPECT_LT(found.compared_files[0].parts[0].after, 4 * kDrawnSigma);
  EXPECT_GT(found.compared_files[1].parts[0].after, 3e-3);
  EXPECT_EQ(found.compared[0].values, 40);
  EXPECT_THAT(found.warnings, ::testing::Not(::testing::Contains(HasSubstr("makes these rows worse"))));
  // Fitted to nearly as many unknowns as rows, noise makes a machine that sound rows contradict.
  const MachineCalibration poor = calibrated({table("few.csv", 13, 3e-3)}, {good});
  EXPECT_THAT(poor.warnings,
              ::testing::Contains(::testing::AllOf(HasSubstr("good.csv"), HasSubstr("makes these rows worse"),
                                                   HasSubstr("--prior"))));
}

TEST_F(ComparedTables, AMapNamesTablesOfItsOwn) {
  const std::string fitted = table("fitted.csv", 80);
  table("others.csv", 20);
  write_file(folder_ / "others.yaml", std::string(kMap) + "file: others.csv\n");
  const MachineCalibration found = calibrated({fitted}, {folder_ / "others.yaml"});
  ASSERT_EQ(found.compared.size(), 1u);
  EXPECT_EQ(found.compared[0].values, 20);
  EXPECT_LT(found.compared[0].after, 4 * kDrawnSigma);
}

// Two labs' hole_0 are two points.
TEST_F(ComparedTables, FilesOfOneNameInTwoFoldersAreTwoPoints) {
  const machine::MachineDescription arm = machine::load_machine("arm");
  std::string text = "j1,j2,j3,j4,j5,j6\n0,0,0,0,0,0\n0.1,0,0,0,0,0\n";
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directory(folder_ / name);
    write_file(folder_ / (std::string(name) + "/hole_0.csv"), text);
  }
  write_file(folder_ / "hole_1.csv", text);
  write_file(folder_ / "sockets.yaml",
             "kind: point\njoints: {columns: [j1, j2, j3, j4, j5, j6], unit: rad}\ntarget: ball\n");
  const ColumnMap map = read_column_map(folder_ / "sockets.yaml");
  const auto points = [&](const std::vector<std::string>& files, const std::vector<std::string>& beside) {
    std::vector<std::string> names;
    for (const MeasurementRow& row : read_measured_rows(map, files, arm, beside).problem.rows)
      if (names.empty() || names.back() != row.place) names.push_back(row.place);
    return names;
  };
  const std::string a = folder_ / "a/hole_0.csv", b = folder_ / "b/hole_0.csv",
                    other = folder_ / "hole_1.csv";
  EXPECT_THAT(points({a, other}, {}), ElementsAre("hole_0", "hole_1"));
  const auto both = points({a, b, other}, {});
  ASSERT_EQ(both.size(), 3u);
  EXPECT_THAT(both[0], ::testing::EndsWith("a/hole_0"));
  EXPECT_THAT(both[1], ::testing::EndsWith("b/hole_0"));
  EXPECT_EQ(both[2], "hole_1");
  EXPECT_THAT(points({a}, {b}), ElementsAre(both[0]));
}

}  // namespace
}  // namespace understudy::calibration

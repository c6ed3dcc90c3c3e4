// Tables in the formats that docs/measurements.md names, made here from rows whose numbers are known.
#include "calibration/table/measured_rows.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/calibration/rows/drawn_rows.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

constexpr int kRows = 14;

class TrackerExports : public ::testing::Test {
 protected:
  /// Rows of one target, seen by a tracker.
  DrawnRows& rows_of(const std::string& machine, const Vec3& p_TG = {-0.05, 0.02, 0.03}) {
    const auto columns = DrawnRows({}, 1, machine).nominal.free_parameters(true, true);
    lab_.emplace(columns, 3, machine);
    lab_->add_in_frame(RowKind::position, "r", make_pose(Mat3(Mat3::Identity()), p_TG), kRows);
    return *lab_;
  }
  static std::string joined(const std::vector<double>& numbers, const char* separator, double factor,
                            int decimals = 6) {
    std::string text;
    for (const double v : numbers)
      text += (text.empty() ? "" : separator) + fmt::format("{:.{}f}", factor * v, decimals);
    return text;
  }
  MeasuredRows read(const std::string& map, const std::vector<std::string>& files = {}) {
    write_file(folder_ / "map.yaml", map);
    std::vector<std::string> paths;
    for (const std::string& file : files) paths.push_back(folder_ / file);
    return read_measured_rows(read_column_map(folder_ / "map.yaml"), paths, lab_->description);
  }
  void expect_read(const MeasuredRows& read, double length, double axis) const {
    ASSERT_EQ(read.problem.rows.size(), lab_->problem.rows.size());
    for (std::size_t j = 0; j < read.problem.rows.size(); ++j) {
      const MeasurementRow& got = read.problem.rows[j];
      const MeasurementRow& wanted = lab_->problem.rows[j];
      EXPECT_LT((got.X_MG.translation() - wanted.X_MG.translation()).norm(), length) << j;
      for (std::size_t i = 0; i < wanted.axes.size(); ++i)
        EXPECT_NEAR(got.axes[i], wanted.axes[i], axis) << j;
    }
  }

  TemporaryFolder folder_;
  std::optional<DrawnRows> lab_;
};

/// Two spaces before units, U(95), micrometres in one column, a target with a number sign, time stamps behind
/// an apostrophe, an empty last column; struts in the controller's own log.
TEST_F(TrackerExports, UnitsInHeadersUncertaintiesOf95PercentAndTimeStamps) {
  DrawnRows& lab = rows_of("hexapod");
  std::string text =
      "X  [mm],Y  [mm],Z  [mm],U(95)  [mm],U(95) X  [mm],U(95) Y  [mm],U(95) Z  [mm],Tilt  [deg],Image RMS  "
      "[\xc2\xb5m],Target,Temperature  [\xc2\xb0"
      "C],Time Stamp,OTG Applied,Delete\r\n";
  std::string log = "l1 [mm]\tl2 [mm]\tl3 [mm]\tl4 [mm]\tl5 [mm]\tl6 [mm]\r\n";
  for (const MeasurementRow& row : lab.problem.rows) {
    const Vec3 p = 1e3 * row.X_MG.translation();
    text += fmt::format(
        "{:.3f},{:.3f},{:.3f},0.012,0.008,0.004,0.006,29.93,0.22,RRR 0.5in #5320,22.8,'11.10.2022 "
        "15:06:48.043,FALSE,\r\n",
        p.x(), p.y(), p.z());
    log += joined(row.axes, "\t", 1e3) + "\r\n";
  }
  write_file(folder_ / "tracker.csv", text);
  write_file(folder_ / "struts.txt", log);
  const MeasuredRows found = read(
      "kind: position\nfile: tracker.csv\njoints: {file: struts.txt, columns: [l1, l2, l3, l4, l5, l6]}\n"
      "position: {columns: [X, Y, Z], sigma_columns: ['U(95) X', 'U(95) Y', 'U(95) Z'], sigma_coverage: "
      "2}\nframe: tracker\ntarget_column: Target\n");
  expect_read(found, 1e-6, 1e-9);
  EXPECT_EQ(found.problem.rows[0].target, "RRR 0.5in #5320");
  EXPECT_TRUE(found.problem.rows[0].noise_told);
  EXPECT_NEAR(found.problem.rows[0].covariance(0, 0), 4e-6 * 4e-6, 1e-18);
  EXPECT_NEAR(found.problem.rows[0].covariance(1, 1), 2e-6 * 2e-6, 1e-18);
}

/// Lines of comment behind two strokes, names of points, spaces after commas, uncertainties, a time.
TEST_F(TrackerExports, CommentsBehindStrokesAndNamesOfPoints) {
  DrawnRows& lab = rows_of("hexapod");
  std::string text = "// Exported points\n// Frame: A::WORLD\n// x, y, z, Ux, Uy, Uz\n";
  int number = 0;
  for (const MeasurementRow& row : lab.problem.rows) {
    const Vec3 p = 1e3 * row.X_MG.translation();
    text += fmt::format("A, main, p{}, {:.6f}, {:.6f}, {:.6f}, 0.01, 0.01, 0.02, 10/11/2022 15:06:48, {}\n",
                        ++number, p.x(), p.y(), p.z(), joined(row.axes, ", ", 1e3));
  }
  write_file(folder_ / "points.txt", text);
  const MeasuredRows found = read(
      "kind: position\ncomment: //\njoints: {columns: [11, 12, 13, 14, 15, 16]}\n"
      "position: {columns: [4, 5, 6], unit: mm, sigma_columns: [7, 8, 9]}\nframe: tracker\n",
      {"points.txt"});
  expect_read(found, 1e-8, 1e-9);
  EXPECT_NEAR(found.problem.rows[0].covariance(2, 2), 20e-6 * 20e-6, 1e-15);
}

/// Three reflectors in one row, without a header, every number with an exponent.
TEST_F(TrackerExports, ThreeReflectorsInOneRow) {
  const Vec3 at[] = {{-0.05, 0.02, 0.03}, {0.04, 0.03, 0.03}, {0, -0.05, 0.05}};
  DrawnRows& lab = rows_of("arm");
  std::string text;
  for (const MeasurementRow& row : lab.problem.rows) {
    for (const Vec3& p_TG : at) {
      const Vec3 p = 1e3 * (lab.X_MS * lab.built.forward(row.axes) * p_TG);
      text += fmt::format("{:.18e} {:.18e} {:.18e} ", p.x(), p.y(), p.z());
    }
    for (const double q : row.axes) text += fmt::format("{:.18e} ", q / kDegree);
    text += "\n";
  }
  write_file(folder_ / "three.csv", text);
  std::string map = "tables:\n";
  for (int k = 0; k < 3; ++k)
    map += fmt::format(
        "  - {{file: three.csv, kind: position, joints: {{columns: [10, 11, 12, 13, 14, 15]}}, position: "
        "{{columns: [{}, {}, {}], unit: mm}}, frame: tracker, target: nest_{}}}\n",
        3 * k + 1, 3 * k + 2, 3 * k + 3, k + 1);
  const MeasuredRows found = read(map);
  ASSERT_EQ(found.problem.rows.size(), 3u * kRows);
  const MeasurementRow& last = found.problem.rows.back();
  EXPECT_EQ(last.target, "nest_3");
  EXPECT_LT((last.X_MG.translation() - lab.X_MS * lab.built.forward(last.axes) * at[2]).norm(), 1e-9);
}

/// Metres in columns that are set off by tabs and spaces.
TEST_F(TrackerExports, MetresBetweenTabsAndSpaces) {
  DrawnRows& lab = rows_of("hexapod");
  std::string text = "         x\t         y\t         z\tl1\tl2\tl3\tl4\tl5\tl6\n";
  for (const MeasurementRow& row : lab.problem.rows) {
    const Vec3 p = row.X_MG.translation();
    text +=
        fmt::format(" {:.6f}\t {:9.6f}\t {:9.6f}\t{}\n", p.x(), p.y(), p.z(), joined(row.axes, "\t", 1, 9));
  }
  write_file(folder_ / "lt.txt", text);
  const std::string map =
      "kind: position\njoints: {columns: [l1, l2, l3, l4, l5, l6], slide_unit: m}\nposition: {columns: [x, "
      "y, z], "
      "unit: m}\nframe: tracker\n";
  expect_read(read(map, {"lt.txt"}), 1e-6, 1e-9);
}

/// A spreadsheet's: first line with the separator, decimal commas, one byte for the micro sign.
TEST_F(TrackerExports, ASpreadsheetWithDecimalCommas) {
  DrawnRows& lab = rows_of("arm");
  std::string text =
      "sep=;\r\nZeit;X (mm);Y (mm);Z (mm);RMS (\xb5m);A1 (deg);A2 (deg);A3 (deg);A4 (deg);A5 "
      "(deg);A6 (deg)\r\n";
  for (const MeasurementRow& row : lab.problem.rows) {
    const Vec3 p = 1e3 * row.X_MG.translation();
    std::string line =
        fmt::format("{:.4f};{:.4f};{:.4f};3.5;{}", p.x(), p.y(), p.z(), joined(row.axes, ";", 1 / kDegree));
    std::replace(line.begin(), line.end(), '.', ',');
    text += "11.10.2022 15:06:48,043;" + line + "\r\n";
  }
  write_file(folder_ / "t.csv", text);
  const std::string joints = "joints: {columns: [A1, A2, A3, A4, A5, A6]}\n";
  expect_read(
      read("kind: position\n" + joints + "position: {columns: [X, Y, Z]}\nframe: tracker\n", {"t.csv"}), 1e-6,
      1e-7);
  try {
    read("kind: position\n" + joints + "position: {columns: [X, Y, Z], unit: m}\nframe: tracker\n",
         {"t.csv"});
    FAIL() << "a unit that the header contradicts was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the header says mm of 'X', the map's position.unit says m"));
  }
}

TEST_F(TrackerExports, StrutsOfAnotherMachineAreRefused) {
  DrawnRows& lab = rows_of("hexapod");
  const auto table = [&](double factor, int columns) {
    std::string text;
    for (const MeasurementRow& row : lab.problem.rows) {
      const Vec3 p = 1e3 * row.X_MG.translation();
      std::vector<double> axes = row.axes;
      axes.resize(static_cast<std::size_t>(columns), 0.2);
      text += fmt::format("{} {} {} {}\n", p.x(), p.y(), p.z(), joined(axes, " ", factor));
    }
    write_file(folder_ / "t.txt", text);
  };
  const auto refused = [&](const std::string& columns) {
    try {
      read("kind: position\njoints: {columns: [" + columns +
               "]}\nposition: {columns: [1, 2, 3], unit: mm}\nframe: tracker\n",
           {"t.txt"});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  table(1e3, 7);
  EXPECT_THAT(refused("4, 5, 6, 7, 8, 9, 10"), HasSubstr("joints.columns names 7 columns, machine"));
  table(1, 6);  // metres
  EXPECT_THAT(refused("4, 5, 6, 7, 8, 9"), HasSubstr("t.txt:1: axis l1 is"));
  EXPECT_THAT(refused("4, 5, 6, 7, 8, 9"), HasSubstr("another machine, or another unit?"));
  table(1e3, 6);
  EXPECT_THAT(refused("5, 4, 6, 7, 8, 9"), HasSubstr("another"));
  EXPECT_EQ(refused("4, 5, 6, 7, 8, 9"), "accepted");
}

}  // namespace
}  // namespace understudy::calibration

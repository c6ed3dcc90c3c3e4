// Pictures of two cameras as files: boards, targets and poses, as a user measures them. The pictures are
// rendered of a built machine and a built rig that differ from what rig.yaml says.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "core/file/read_file.h"
#include "core/frames.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Row = std::map<std::string, std::string>;

/// A CSV without quotes; lines that begin with # are comments.
std::vector<Row> table_of(const std::string& text) {
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::vector<Row> rows;
  std::vector<std::string> header;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto cells = cells_of(line);
    if (header.empty()) {
      header = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), header.size()) << line;
    Row row;
    for (std::size_t i = 0; i < std::min(cells.size(), header.size()); ++i) row[header[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

Vec3 tip_mm(const Row& row) { return {number(row, "x_mm"), number(row, "y_mm"), number(row, "z_mm")}; }

Mat3 rotation(const Row& row) {
  return Quat(number(row, "qw"), number(row, "qx"), number(row, "qy"), number(row, "qz"))
      .normalized()
      .toRotationMatrix();
}

/// um and mrad; the frame's share about `middle_mm` included.
Mat6 covariance(const Row& row, const Vec3& middle_mm) {
  Mat6 c;
  for (int i = 1; i <= 6; ++i)
    for (int j = i; j <= 6; ++j)
      c(i - 1, j - 1) = c(j - 1, i - 1) = number(row, "c" + std::to_string(i) + std::to_string(j) +
                                                          (j <= 3   ? "_um2"
                                                           : i <= 3 ? "_um_mrad"
                                                                    : "_mrad2"));
  const double position = number(row, "frame_um"), turn = number(row, "frame_mrad"),
               strain = number(row, "frame_permille");
  const Vec3 r = tip_mm(row) - middle_mm;  // one mrad over a mm is a um, and so is a permille
  Mat3 cross;
  cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  const Mat3 squares = r.squaredNorm() * Mat3::Identity(), along = r * r.transpose();
  Mat3 strained = along;
  strained.diagonal() = squares.diagonal();
  c.topLeftCorner<3, 3>() +=
      position * position * Mat3::Identity() + turn * turn * (squares - along) + strain * strain * strained;
  c.topRightCorner<3, 3>() -= turn * turn * cross;
  c.bottomLeftCorner<3, 3>() -= turn * turn * cross.transpose();
  c.bottomRightCorner<3, 3>() += turn * turn * Mat3::Identity();
  return c;
}

/// Grey of one level, as PGM, whatever the name says.
std::string plain_picture(int width, int height, char level) {
  return "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n" +
         std::string(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), level);
}

/// Pictures of four poses. CTest runs each test on its own, so one test makes them for all that is asked of
/// them.
class Pictures {
 public:
  Pictures()
      : made_(understudy(
            "sample-poses --count 4 --design random --as-built manufactured --seed 5 --from pixels "
            "--pictures " +
            (folder_ / "pictures") + " -o " + (folder_ / "rendered.csv"))) {}
  const Outcome& made() const { return made_; }
  std::string operator/(const std::string& name) const { return folder_ / ("pictures/" + name); }
  std::string measure_pose(const std::string& arguments, const std::string& output) const {
    return "measure pose " + arguments + " --rig " + *this / "rig.yaml" + " --commanded " +
           *this / "commanded.csv" + " --seed 5 -o " + output;
  }
  /// As sample-poses measured the same pictures.
  std::string measured_when_made() const { return folder_ / "rendered.csv"; }

 private:
  Folder folder_;
  Outcome made_;
};

// The boards' errors are common to all poses, so the mean over poses of errors over their covariance has
// between six and 24 degrees of freedom: 0.38 to 22.5 in 998 of 1000 with six, the worst case.
void poses_are_the_true_ones_within_their_covariance(const Pictures& pictures) {
  const Folder folder;
  const Outcome outcome = understudy(pictures.measure_pose((pictures / "poses/*.png"), folder / "m.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("4 of 4 poses"));
  EXPECT_EQ(outcome.err, "");
  const auto measured = table_of(read_file(folder / "m.csv")),
             truth = table_of(read_file(pictures / "truth/poses.csv")),
             rendered = table_of(read_file(pictures.measured_when_made())),
             commanded = table_of(read_file(pictures / "commanded.csv"));
  ASSERT_EQ(measured.size(), 4u);
  ASSERT_EQ(truth.size(), 4u);
  Vec3 middle = Vec3::Zero();
  for (const Row& row : measured) middle += tip_mm(row) / 4;
  double normalised = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    Twist e;
    e << 1e3 * (tip_mm(truth[i]) - tip_mm(measured[i])),
        1e3 * log_rotation(Mat3(rotation(truth[i]) * rotation(measured[i]).transpose()));
    normalised += e.dot(covariance(measured[i], middle).ldlt().solve(e)) / 4;
    // The machine was somewhere else than it was sent to, by much more than the pictures' error.
    EXPECT_GT((tip_mm(truth[i]) - tip_mm(commanded[i])).norm(), 0.2);
    EXPECT_LT((tip_mm(truth[i]) - tip_mm(measured[i])).norm(), 0.1);
    EXPECT_EQ(measured[i].at("l1_mm"), commanded[i].at("l1_mm"));
    // sample-poses measures the same pictures before it writes them; rig.yaml has 15 digits.
    EXPECT_LT((tip_mm(rendered[i]) - tip_mm(measured[i])).norm(), 1e-5);
  }
  EXPECT_LT(normalised, 22.5);
  EXPECT_GT(normalised, 0.38);
}

void the_table_is_one_that_calibrate_reads(const Pictures& pictures) {
  const Folder folder;
  ASSERT_EQ(understudy(pictures.measure_pose((pictures / "poses/*.png"), folder / "m.csv")).status, 0);
  // Four poses say too little for 42 parameters: the table is understood, and the answer is about the poses.
  const Outcome few = understudy("calibrate " + (folder / "m.csv") + " -o " + (folder / "m.yaml"));
  EXPECT_EQ(few.status, 2);
  EXPECT_THAT(few.err, HasSubstr("4 "));
}

void boards_give_a_corner_a_row_and_a_residual_a_camera(const Pictures& pictures) {
  const Folder folder;
  const Outcome outcome =
      understudy("measure board --rig " + (pictures / "rig.yaml") + " -o " + (folder / "corners.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto corners = table_of(read_file(folder / "corners.csv"));
  EXPECT_EQ(corners.size(), 2u * 11 * 12 * 9);
  EXPECT_EQ(corners[0].at("picture"), (pictures / "boards/camera0-layer00.png"));
  EXPECT_EQ(corners[107].at("column"), "11");
  EXPECT_EQ(corners[107].at("row"), "8");
  for (const Row& row : corners) {
    EXPECT_GT(number(row, "sigma_px"), 0.005);
    EXPECT_LT(number(row, "sigma_px"), 0.057);  // the product's 0.08 px in two directions
  }
  for (const char* camera : {"camera 0", "camera 1"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string(camera) + ": 11 of 11 boards"));
  const std::size_t at = outcome.out.find("residual ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(std::stod(outcome.out.substr(at + 9)), 0.057);
}

void targets_have_a_centre_and_its_covariance(const Pictures& pictures) {
  const Outcome outcome =
      understudy("measure targets " + (pictures / "poses/pose-0002-camera1.png") + " --rig " +
                 (pictures / "rig.yaml") + " --commanded " + (pictures / "commanded.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("3 of 3 targets in 1 pictures"));
  const auto targets = table_of(outcome.out);
  ASSERT_EQ(targets.size(), 3u);
  EXPECT_EQ(targets[2].at("pose"), "2");
  EXPECT_EQ(targets[2].at("camera"), "1");
  EXPECT_EQ(targets[2].at("target"), "2");
  for (const Row& row : targets) {
    // 5 mm at 400 mm and 4267 px, 50 mm nearer or farther.
    EXPECT_NEAR(number(row, "radius_px"), 53.3, 8);
    EXPECT_LT(std::sqrt(number(row, "c11_px2") + number(row, "c22_px2")), 0.06);
    EXPECT_LT(std::pow(number(row, "c12_px2"), 2), number(row, "c11_px2") * number(row, "c22_px2"));
  }
}

void a_pose_without_targets_is_named_and_left_out(const Pictures& pictures) {
  const Folder folder;
  for (const char* name : {"pose-0001-camera0.png", "pose-0001-camera1.png", "pose-0002-camera0.png"})
    fs::copy(pictures / (std::string("poses/") + name), folder / name);
  folder.write("pose-0002-camera1.png", plain_picture(1600, 1200, static_cast<char>(200)));
  const Outcome some =
      understudy(pictures.measure_pose(folder.path().string() + "/pose-*.png", folder / "m.csv"));
  EXPECT_EQ(some.status, 0) << some.err;
  EXPECT_THAT(some.err, AllOf(HasSubstr("pose-0002-camera1.png: pose 2, camera 1, target 0: "),
                              HasSubstr("too little contrast; left out")));
  EXPECT_EQ(table_of(read_file(folder / "m.csv")).size(), 1u);
  const Outcome none =
      understudy(pictures.measure_pose(folder.path().string() + "/pose-0002*.png", folder / "none.csv"));
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, HasSubstr("nothing was measured"));
  EXPECT_FALSE(fs::exists(folder / "none.csv"));
}

void mistakes_are_refused_in_one_line_and_nothing_is_written(const Pictures& pictures) {
  const Folder folder;
  const std::string out = folder / "out.csv", first = (pictures / "poses/pose-0001-camera0.png"),
                    rig = " --rig " + (pictures / "rig.yaml"),
                    commanded = " --commanded " + (pictures / "commanded.csv");
  folder.write("pose-0001-camera1.png", plain_picture(40, 30, 100));
  folder.write("pose-0003-camera0.png", "no picture");
  fs::copy(first, folder / "pose-0009-camera0.png");
  fs::copy(first, folder / "pose-0009-camera1.png");
  fs::copy(pictures / "rig.yaml", folder / "rig.yaml");
  folder.write("bad.yaml", "cameras: 3\n");
  const int before = folder.entries();
  const std::vector<std::pair<std::string, std::string>> calls{
      {pictures.measure_pose(first, out),
       "pose-0001-camera0.png: is not paired: pose-0001-camera1.png of camera 1"},
      {pictures.measure_pose(first + " " + (folder / "pose-0001-camera1.png"), out),
       "has 40 x 30 px, must have the 1600 x 1200 px"},
      {pictures.measure_pose(
           (folder / "pose-0003-camera0.png") + " " + (pictures / "poses/pose-0003-camera1.png"), out),
       "pose-0003-camera0.png: holds no picture"},
      {pictures.measure_pose((folder / "pose-0009-camera0.png") + " " + (folder / "pose-0009-camera1.png"),
                             out),
       "is of pose 9; " + (pictures / "commanded.csv") + " has 4 rows"},
      {pictures.measure_pose("absent-0001-camera0.png", out),
       "does not fit the pattern poses/pose-{pose:04}-camera{camera}.png"},
      {"measure pose " + (pictures / "poses/*.png") + " --rig " + (folder / "rig.yaml") + commanded + " -o " +
           out,
       "boards/camera0-layer00.png"},
      {"measure pose " + (pictures / "poses/*.png") + rig + " --commanded absent.csv -o " + out,
       "absent.csv"},
      {"measure targets " + first + rig + " -o " + out, "--commanded"},
      {"measure board --rig " + (folder / "bad.yaml") + " -o " + out, "bad.yaml:1:"},
      {"measure board camera0-layer00.png --rig " + (pictures / "rig.yaml") + " -o " + out,
       "camera0-layer00.png"},
      {"measure board -o " + out, "--rig"},
      {"measure", "subcommand"},
  };
  for (const auto& [words, part] : calls) {
    const Outcome outcome = understudy(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << words;
    EXPECT_EQ(folder.entries(), before) << words;
  }
}

TEST(ExtendedMeasure, PicturesFromFilesGiveBoardsTargetsAndPoses) {
  const Pictures pictures;
  ASSERT_EQ(pictures.made().status, 0) << pictures.made().err;
  poses_are_the_true_ones_within_their_covariance(pictures);
  the_table_is_one_that_calibrate_reads(pictures);
  boards_give_a_corner_a_row_and_a_residual_a_camera(pictures);
  targets_have_a_centre_and_its_covariance(pictures);
  a_pose_without_targets_is_named_and_left_out(pictures);
  mistakes_are_refused_in_one_line_and_nothing_is_written(pictures);
}

// Boards as a print shop makes them; the machine is driven on a plant. `calibrate bundle` finds it from the
// tables of `measure`.
TEST(ExtendedMeasure, TablesOfAllPicturesCalibrateAMachineAtOnce) {
  const Folder folder;
  const std::string rig = " --rig " + (folder / "p/rig.yaml"),
                    commanded = " --commanded " + (folder / "p/commanded.csv");
  const Outcome made = understudy(
      "sample-poses --count 10 --as-built manufactured --seed 5 --engine quasistatic --from pixels "
      "--board-offset 0.2 "
      "--board-rotation 2 --board-print 1 --board-flatness 50 --pictures " +
      (folder / "p") + " -o " + (folder / "m.csv"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(table_of(read_file(folder / "p/commanded.csv"))[0].count("a6"), 1u);
  ASSERT_EQ(understudy("measure board" + rig + " -o " + (folder / "corners.csv")).status, 0);
  ASSERT_EQ(understudy("measure targets " + (folder / "p/poses/*.png") + rig + commanded + " -o " +
                       (folder / "targets.csv"))
                .status,
            0);
  const std::string call = "calibrate bundle" + rig + commanded + " --corners " + (folder / "corners.csv") +
                           " --targets " + (folder / "targets.csv") + " -o ";
  const Outcome found = understudy(call + (folder / "calibrated.yaml") + " --report " + (folder / "report"));
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("bundle_with_play"));
  EXPECT_TRUE(fs::exists(folder / "report/report.html"));
  EXPECT_EQ(understudy("sample-poses --count 3 --design random --machine " + (folder / "calibrated.yaml") +
                       " -o " + (folder / "again.csv"))
                .status,
            0);
  const Outcome refused = understudy(call + (folder / "arm.yaml") + " --machine arm");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("hexapod only"));
  EXPECT_FALSE(fs::exists(folder / "arm.yaml"));
}

TEST(SamplePictures, NeedAMeasurementFromPixels) {
  const Folder folder;
  const Outcome outcome = understudy("sample-poses --as-built manufactured --pictures " + (folder / "p") +
                                     " -o " + (folder / "m.csv"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--pictures needs --from pixels"));
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace understudy::cli_test

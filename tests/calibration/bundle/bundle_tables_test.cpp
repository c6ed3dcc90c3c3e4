#include "calibration/bundle/bundle_tables.h"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class BundleTables : public ::testing::Test {
 protected:
  BundleTables() : file_(folder_ / "bundle-table.csv") {
    rig_.board.columns = 2, rig_.board.rows = 3, rig_.layers = 2;
  }

  std::vector<vision::SeenBoard> corners(const std::string& text) {
    write_file(file_, text);
    return read_corners(file_.string(), rig_);
  }
  std::vector<PoseTargets> targets(const std::string& text) {
    write_file(file_, text);
    return read_targets(file_.string());
  }
  static std::string board(int camera, int layer, int rows = 6) {
    std::string text;
    for (int i = 0; i < rows; ++i)
      text +=
          fmt::format("\"a, b.png\",{},{},{},{},{},{},0.04\n", camera, layer, i % 2, i / 2, 100 + i, 200 - i);
    return text;
  }
  static constexpr const char* kCorners = "picture,camera,layer,column,row,u_px,v_px,sigma_px\n";
  static constexpr const char* kTargets =
      "picture,pose,camera,target,u_px,v_px,c11_px2,c12_px2,c22_px2,radius_px\n";

  TemporaryFolder folder_;
  std::filesystem::path file_;
  vision::CalibrationRig rig_;
};

TEST_F(BundleTables, BoardsComeWithTheirCornersInOrder) {
  rig_.layers = 2;
  const auto boards = corners("# by hand\n" + std::string(kCorners) + board(1, 0) + board(0, 1));
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[0].camera, 0);
  EXPECT_EQ(boards[0].layer, 1);
  ASSERT_EQ(boards[1].corners_px.size(), 6u);
  EXPECT_EQ(boards[1].corners_px[5], Vec2(105, 195));
}

TEST_F(BundleTables, TargetsAreGatheredByPose) {
  const auto poses = targets(std::string(kTargets) + "p.png,2,1,0,10,20,0.01,0.001,0.02,50\n" +
                             "p.png,2,0,2,11,21,0.01,0,0.02,50\nq.png,1,0,0,1,2,0.01,0,0.02,50\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].pose, 1);
  EXPECT_EQ(poses[1].found, 2);
  EXPECT_EQ(poses[1].line, 2);
  EXPECT_EQ(poses[1].targets[1][0].pixel, Vec2(10, 20));
  EXPECT_EQ(poses[1].targets[1][0].covariance(0, 1), 0.001);
}

TEST_F(BundleTables, RefusesWhatIsNoSuchTableByLine) {
  const auto bad_corners = [&](const std::string& text, const char* why) {
    EXPECT_THAT([&] { corners(text); }, ThrowsMessage<InputError>(HasSubstr(why))) << text;
  };
  const auto bad_targets = [&](const std::string& text, const char* why) {
    EXPECT_THAT([&] { targets(text); }, ThrowsMessage<InputError>(HasSubstr(why))) << text;
  };
  const std::string corner = kCorners, target = kTargets;
  bad_corners("", "is empty");
  bad_corners("picture,camera,layer,column,row,u_px,v_px\n", "column sigma_px is missing");
  bad_corners(corner + "a.png,2,0,0,0,1,1,0.1\n", ":2: camera is 2, must be a whole number in 0..1");
  bad_corners(corner + "a.png,0,0,0.5,0,1,1,0.1\n", "column is 0.5");
  bad_corners(corner + board(0, 0, 5), "camera 0, layer 0: 5 corners of 6");
  bad_corners(corner + board(0, 0) + board(0, 0, 1), ":8: camera 0, layer 0: a corner is given twice");
  bad_corners(corner + "a.png,0,0\n", "has 3 cells, the header 8");
  bad_targets(target + "a.png,0,0,0,1,1,1,0,1,50\n", "pose is 0");
  bad_targets(target + "a.png,1,0,0,1,nan,1,0,1,50\n", "v_px");
  bad_targets(target + "a.png,1,0,0,1,1,1,2,1,50\n", ":2: the covariance");
  bad_targets(target + "a.png,1,0,0,1,1,1,0,1,50\na.png,1,0,0,1,1,1,0,1,50\n", ":3: pose 1, camera 0");
}

}  // namespace
}  // namespace understudy::calibration

#include "vision/boards/rig_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "tests/complaint.h"
#include "tests/temporary_folder.h"
#include "tests/vision/boards/drawn_picture.h"
#include "tests/vision/boards/two_cameras.h"

namespace understudy::vision {
namespace {

using ::testing::HasSubstr;

RigDescription description() {
  RigDescription d;
  d.file = "rigs/rig.yaml";
  d.rig = reference_rig();
  d.rig.layers = 3;
  d.board_pictures = board_picture_name();
  d.pose_pictures = pose_picture_name();
  return d;
}

TEST(RigPictures, WithoutFilesTheBoardsAreThoseThatTheRigNames) {
  const auto boards = board_pictures(description(), {});
  ASSERT_EQ(boards.size(), 6u);
  EXPECT_EQ(boards[4].file, "rigs/boards/camera1-layer01.png");
  EXPECT_EQ(boards[4].camera, 1);
  EXPECT_EQ(boards[4].layer, 1);
}

TEST(RigPictures, FilesAreSortedByWhatTheirNamesSay) {
  const auto boards = board_pictures(description(), {"a/camera1-layer00.png", "b/camera0-layer02.png"});
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[0].file, "b/camera0-layer02.png");
  const auto pairs = pose_picture_pairs(description(), {"pose-0002-camera1.png", "pose-0001-camera0.png",
                                                        "pose-0002-camera0.png", "pose-0001-camera1.png"});
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[1][0].file, "pose-0002-camera0.png");
  EXPECT_EQ(pairs[1][1].pose, 2);
}

TEST(RigPictures, NamesThatCannotBePlacedAreRefused) {
  const RigDescription d = description();
  const auto board = [&](const std::vector<std::string>& files) {
    return complaint([&] { board_pictures(d, files); });
  };
  const auto pair = [&](const std::vector<std::string>& files) {
    return complaint([&] { pose_picture_pairs(d, files); });
  };
  EXPECT_THAT(board({"x.png"}), HasSubstr("x.png: its name does not fit the pattern boards/camera{camera}"));
  EXPECT_THAT(board({"camera2-layer00.png"}), HasSubstr("is of camera 2; the set-up has cameras 0 and 1"));
  EXPECT_THAT(board({"camera0-layer03.png"}), HasSubstr("is of layer 3; rigs/rig.yaml has layers 0 to 2"));
  EXPECT_THAT(board({"a/camera0-layer01.png", "b/camera0-layer01.png"}),
              HasSubstr("b/camera0-layer01.png: shows what a/camera0-layer01.png shows"));
  EXPECT_THAT(pair({"pose-0000-camera0.png"}), HasSubstr("poses are numbered from 1"));
  EXPECT_THAT(pair({"pose-0001-camera0.png", "pose-0002-camera0.png", "pose-0002-camera1.png"}),
              HasSubstr("pose-0001-camera0.png: is not paired: pose-0001-camera1.png of camera 1"));
  EXPECT_THAT(pair({"pose-0001-camera1.png"}), HasSubstr("pose-0001-camera0.png of camera 0 is not among"));
}

// A picture as PGM: a header in words and the levels behind it.
TEST(RigPictures, BoardsAreMeasuredFromFilesOfTheSensorsSize) {
  RigDescription d = description();
  d.rig.board = Board{7, 4, 10e-3, 2.5e-3};
  for (MountedCamera& mounted : d.rig.cameras) mounted.camera.width = 400, mounted.camera.height = 300;
  const Image drawn = drawn_board(400, 300, d.rig.board, Vec2(70.5, 80.5), 40);
  const TemporaryFolder folder;
  const auto pgm = [&](const std::string& name, int width, int height) {
    write_file(folder / name, "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n" +
                                  std::string(drawn.pixels.begin(), drawn.pixels.begin() + width * height));
    return (folder / name).string();
  };
  const auto boards =
      measure_boards(d, {{pgm("whole.pgm", 400, 300), 0, 1}, {pgm("other.pgm", 400, 300), 1, 0}});
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[0].seen.status, BoardStatus::ok);
  const auto seen = seen_boards(boards);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].layer, 1);
  EXPECT_EQ(seen[1].camera, 1);
  EXPECT_EQ(seen[0].corners_px.size(), 28u);
  EXPECT_THAT(complaint([&] {
                measure_boards(d, {{pgm("small.pgm", 400, 200), 0, 0}});
              }),
              HasSubstr("has 400 x 200 px, must have the 400 x 300 px of camera 0 in rigs/rig.yaml"));
}

}  // namespace
}  // namespace understudy::vision

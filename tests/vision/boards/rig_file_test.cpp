#include "vision/boards/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy::vision {
namespace {

using ::testing::HasSubstr;

const std::string kExample = std::string(UNDERSTUDY_SOURCE_DIR) + "/examples/rig.yaml";

/// A file that is removed with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) : path_((folder_ / "rig.yaml").string()) {
    write_file(path_, text);
  }
  const std::string& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

void expect_same(const CalibrationRig& a, const CalibrationRig& b) {
  constexpr double kDigits = 1e-12;  // [m]: the file has nanometres to three digits
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.cameras[i].camera.width, b.cameras[i].camera.width);
    EXPECT_EQ(a.cameras[i].camera.height, b.cameras[i].camera.height);
    EXPECT_EQ(a.cameras[i].camera.focal_px, b.cameras[i].camera.focal_px);
    EXPECT_EQ(a.cameras[i].camera.centre_px, b.cameras[i].camera.centre_px);
    EXPECT_TRUE(a.cameras[i].X_WC.isApprox(b.cameras[i].X_WC, kDigits)) << i;
  }
  EXPECT_EQ(a.board.columns, b.board.columns);
  EXPECT_EQ(a.board.rows, b.board.rows);
  EXPECT_NEAR(a.board.square, b.board.square, kDigits);
  EXPECT_NEAR(a.board.margin, b.board.margin, kDigits);
  EXPECT_EQ(a.layers, b.layers);
  EXPECT_NEAR(a.layer_spacing, b.layer_spacing, kDigits);
  EXPECT_NEAR(a.middle_distance, b.middle_distance, kDigits);
  EXPECT_NEAR(a.target_radius, b.target_radius, kDigits);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE((a.targets[k] - b.targets[k]).norm(), kDigits);
}

TEST(RigFile, TheExampleIsTheReferencesSetUpBeforeTheHexapod) {
  const RigDescription d = load_rig(kExample);
  expect_same(d.rig, default_calibration_rig(Vec3(0, 0, 50e-3)));
  EXPECT_DOUBLE_EQ(d.uncertainty.boards.offset, 20e-6);
  EXPECT_DOUBLE_EQ(d.uncertainty.boards.rotation, 0.2e-3);
  EXPECT_EQ(d.uncertainty.corner_px, 0.04);
  EXPECT_EQ(d.uncertainty.principal_px, 0.1);
  EXPECT_EQ(d.board_picture(1, 7),
            std::string(UNDERSTUDY_SOURCE_DIR) + "/examples/boards/camera1-layer07.png");
}

TEST(RigFile, APrintIsExactUnlessTheFileSaysOtherwise) {
  RigDescription rig = load_rig(kExample);
  EXPECT_EQ(rig.uncertainty.boards.print_scale, 0);
  rig.uncertainty.boards.print_scale = 1e-3;
  rig.uncertainty.boards.flatness = 50e-6;
  const TemporaryFile file(rig_yaml(rig, "test"));
  const RigDescription read = load_rig(file.path());
  EXPECT_NEAR(read.uncertainty.boards.print_scale, 1e-3, 1e-15);
  EXPECT_NEAR(read.uncertainty.boards.flatness, 50e-6, 1e-15);
  EXPECT_EQ(read.uncertainty.corner_px, rig.uncertainty.corner_px);
}

TEST(RigFile, WhatIsWrittenReadsBack) {
  RigDescription d = load_rig(kExample);
  d.rig.cameras[1].camera.k1 = -0.123456789;
  d.rig.cameras[0].X_WC =
      d.rig.cameras[0].X_WC * make_pose(exp_rotation(Vec3(0.1, -0.2, 0.3)), Vec3(1e-3, 0, 0));
  d.uncertainty.boards.scale = 3e-4;
  const TemporaryFile file(rig_yaml(d, "a comment"));
  const RigDescription back = load_rig(file.path());
  expect_same(back.rig, d.rig);
  EXPECT_EQ(back.rig.cameras[1].camera.k1, -0.123456789);
  EXPECT_DOUBLE_EQ(back.uncertainty.boards.scale, 3e-4);
  EXPECT_EQ(back.pose_pictures.pattern(), d.pose_pictures.pattern());
}

TEST(RigFile, AMistakeIsRefusedWithItsLineAndWhatIsWrong) {
  const std::string good = read_file(kExample);
  const auto message = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = good;
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "the example has no " + from;
    const TemporaryFile file(text.replace(at, from.size(), to));
    try {
      load_rig(file.path());
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("focal_px: 4267", "focal_px: 4"), HasSubstr("yaml:6:"));
  EXPECT_THAT(message("focal_px: 4267", "focal_mm: 50"), HasSubstr("unknown key 'cameras[1].focal_mm'"));
  EXPECT_THAT(message("[0.5, -0.5, 0.5, -0.5]", "[0.6, -0.5, 0.5, -0.5]"), HasSubstr("has length 1.053"));
  EXPECT_THAT(message("  rows: 9", "  rows: 8"), HasSubstr("board.rows is 8 beside 12 columns"));
  EXPECT_THAT(message("layers: 11", "layers: 1"), HasSubstr("layers is 1, outside 2"));
  EXPECT_THAT(message("spacing_mm: 5", "spacing_mm: 80"),
              HasSubstr("puts the nearest layer 0 mm before the camera"));
  EXPECT_THAT(message("    - centre_mm: [0, 0, 0]\n", ""),
              HasSubstr("targets.centres has 2 targets, must have 3"));
  EXPECT_THAT(message("[0, 42.426406871193, 42.426406871193]", "[1, 0, 1]"), HasSubstr("lie in one line"));
  EXPECT_THAT(message("radius_mm: 5", "radius_mm: 0.5"), HasSubstr("radius of 5.33375 px in camera 0"));
  EXPECT_THAT(message("{layer:02}", ""), HasSubstr("board_pictures: {layer} is missing"));
  EXPECT_THAT(message("board_offset_um: 20", "board_offset_um: -1"), HasSubstr("outside 0 to 100000 um"));
  const std::size_t second = good.find("  - width_px", good.find("  - width_px") + 1);
  EXPECT_THAT(message(good.substr(second, good.find("board:") - second), ""),
              HasSubstr("cameras has 1 cameras"));
}

}  // namespace
}  // namespace understudy::vision

#include "calibration/bundle/calibrate_bundle.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/machine/measurement_table.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/calibration/bundle/drawn_bundle.h"
#include "tests/temporary_folder.h"
#include "vision/boards/rig_file.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// The files of a lab: set-up, corners, targets, commanded poses.
class CalibrateBundle : public ::testing::Test {
 protected:
  std::string path(const char* name) const { return (folder_ / name).string(); }

  /// `lost`: the pose of which a target is missing; 0: none.
  BundleRequest written(const DrawnBundle& drawn, int lost = 0) const {
    const BundleProblem& p = drawn.problem;
    vision::RigDescription rig;
    rig.rig = p.rig;
    rig.uncertainty = p.uncertainty;
    rig.board_pictures = vision::board_picture_name();
    rig.pose_pictures = vision::pose_picture_name();
    write_file(path("rig.yaml"), vision::rig_yaml(rig, "test"));
    std::string corners = "picture,camera,layer,column,row,u_px,v_px,sigma_px\n";
    for (const vision::SeenBoard& board : p.boards)
      for (int i = 0; i < p.rig.board.corners(); ++i) {
        const Vec2& at = board.corners_px[static_cast<std::size_t>(i)];
        corners += fmt::format("x.png,{},{},{},{},{:.6f},{:.6f},0.04\n", board.camera, board.layer,
                               i % p.rig.board.columns, i / p.rig.board.columns, at.x(), at.y());
      }
    write_file(path("corners.csv"), corners);
    std::string targets = "picture,pose,camera,target,u_px,v_px,c11_px2,c12_px2,c22_px2,radius_px\n";
    Measurements commanded;
    for (const BundlePose& pose : p.poses) {
      MeasuredPose row;
      row.X_WT = p.X_WB * pose.X_BT;
      for (std::size_t i = 0; i < kStruts; ++i)
        row.axes.push_back(pose.displacement[i] + p.nominal.geometry.length_offset[i]);
      commanded.poses.push_back(row);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t k = pose.number == lost && c == 1 ? 1 : 0; k < 3; ++k) {
          const vision::PixelPoint& at = pose.targets[c][k];
          targets += fmt::format("x.png,{},{},{},{:.6f},{:.6f},{:.8g},{:.8g},{:.8g},50\n", pose.number, c, k,
                                 at.pixel.x(), at.pixel.y(), at.covariance(0, 0), at.covariance(0, 1),
                                 at.covariance(1, 1));
        }
    }
    write_file(path("targets.csv"), targets);
    write_file(path("commanded.csv"), measurements_csv(commanded, hexapod(), "test"));
    BundleRequest request;
    request.rig = path("rig.yaml");
    request.corners = path("corners.csv");
    request.targets = path("targets.csv");
    request.commanded = path("commanded.csv");
    return request;
  }

  const TemporaryFolder folder_;
};

// Without sides, half of the play counts as noise of the lengths; drawn machines have that noise here.
DrawnSetting with_play_as_noise() {
  DrawnSetting setting;
  setting.drives.length = std::hypot(drive_tolerance(hexapod(), true).length, 37.5e-6);
  return setting;
}

TEST_F(CalibrateBundle, AMachineFromFilesIsTheOneThatItsCovarianceStates) {
  const DrawnBundle drawn = draw_bundle(with_play_as_noise(), 11);
  const MachineCalibration result = calibrate_bundle(written(drawn));
  EXPECT_EQ(result.estimator, "bundle");
  EXPECT_EQ(result.poses.size(), 24u);
  const auto degrees = static_cast<double>(result.degrees_of_freedom);
  EXPECT_NEAR(result.chi_square / degrees, 1, 5 * std::sqrt(2 / degrees));
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
  // 43 numbers (dev is one of them): no error is beyond 4.5 sigma by chance.
  for (const ParameterLine& p : result.parameters) {
    if (p.name.find("base joint 1 ") == std::string::npos) continue;
    const auto axis = static_cast<Eigen::Index>(p.name.back() - 'x');
    const double truth = to_mm(drawn.truth.machine.geometry.base_joint[0][axis]);
    EXPECT_LT(std::abs(p.after - truth), 4.5 * p.sigma) << p.name;
    EXPECT_GT(p.sigma, 0.01) << p.name;
  }
  EXPECT_EQ(result.stored.covariance.rows(), 43);
  EXPECT_GT(result.tip.rms, 40e-6);  // what 22 boards of 0.2 mm leave of frame W: 43 um an axis
  EXPECT_LT(result.tip.rms, 200e-6);
}

TEST_F(CalibrateBundle, APoseWithAMissingTargetIsLeftOut) {
  const MachineCalibration result = calibrate_bundle(written(draw_bundle(with_play_as_noise(), 12), 7));
  EXPECT_EQ(result.poses.size(), 23u);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0], HasSubstr("pose 7: 5 of 6 targets were found"));
}

TEST_F(CalibrateBundle, NoiseThatIsUnderstatedIsAWarning) {
  DrawnSetting setting = with_play_as_noise();
  setting.target_px = setting.corner_px = 0.2;
  DrawnBundle drawn = draw_bundle(setting, 13);
  drawn.problem.uncertainty.corner_px = 0.04;
  const MachineCalibration result = calibrate_bundle(written(drawn));
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings.back(), HasSubstr("noise is understated"));
}

TEST_F(CalibrateBundle, RefusesAPoseThatWasNotCommandedAndAnArm) {
  BundleRequest request = written(draw_bundle(with_play_as_noise(), 14));
  const std::string targets = read_file(request.targets);
  write_file(request.targets, targets + "x.png,25,0,0,1,1,1,0,1,50\n");
  EXPECT_THAT([&] { calibrate_bundle(request); },
              ThrowsMessage<InputError>(HasSubstr("pose 25 is not commanded")));
  request.machine = "arm";
  EXPECT_THAT([&] { calibrate_bundle(request); }, ThrowsMessage<InputError>(HasSubstr("hexapod only")));
}

}  // namespace
}  // namespace understudy::calibration

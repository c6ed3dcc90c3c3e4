#include "calibration/machine/camera_poses.h"

#include <gtest/gtest.h>

#include <cmath>

namespace understudy::calibration {
namespace {

vision::PoseMeasurement measured(const Vec3& tip) {
  vision::PoseMeasurement m;
  m.status = vision::PoseStatus::ok;
  m.X_WT = make_pose(Quat::Identity(), tip);
  m.covariance = 4e-12 * Mat6::Identity();
  m.systematic = 25e-12 * Mat6::Identity();
  m.beyond = 2e-3;
  return m;
}

/// Two devices, each off by 5 um along one axis in all poses.
vision::PoseMeasurement shifted(const Vec3& tip) {
  vision::PoseMeasurement m = measured(tip);
  for (const double side : {-1.0, 1.0}) {
    Twist shift = Twist::Zero();
    shift[0] = side * 5e-6;
    m.replicas.push_back(shift);
  }
  return m;
}

TEST(CameraPoses, AMeasuredPoseHasBothSharesOfItsCovariance) {
  const CameraPose pose = camera_pose(measured(Vec3(1, 2, 3)));
  EXPECT_TRUE(pose.ok());
  EXPECT_TRUE(pose.X_WT.translation().isApprox(Vec3(1, 2, 3)));
  EXPECT_TRUE(pose.covariance.isApprox(29e-12 * Mat6::Identity(), 1e-12));
  EXPECT_TRUE(pose.detection.isApprox(4e-12 * Mat6::Identity(), 1e-12));
  EXPECT_EQ(pose.beyond, 2e-3);
}

TEST(CameraPoses, AFailureNamesCameraTargetAndReason) {
  vision::PoseMeasurement m;
  m.status = vision::PoseStatus::target_not_measured;
  m.camera = 1, m.target = 2;
  m.target_status = vision::TargetStatus::partly_hidden;
  EXPECT_EQ(camera_pose(m).failure, "camera 1, target 2: the target is partly hidden");
  m = {};
  m.status = vision::PoseStatus::view_rays_do_not_meet;
  m.target = 0;
  EXPECT_EQ(camera_pose(m).failure, "target 0: the two view rays of a target do not meet");
  m.status = vision::PoseStatus::wrong_shape;
  m.target = -1;
  EXPECT_EQ(camera_pose(m).failure, "the targets do not form their triangle");
}

// A shift that all poses share is the frame's: 5 um along one of three axes are 5 / sqrt(3) um for each.
TEST(CameraPoses, TheTableHasTheRowsThatWereMeasuredAndTheFramesShareOnItsOwn) {
  Measurements commanded;
  std::vector<CameraPose> poses;
  for (int i = 0; i < 6; ++i) {
    MeasuredPose row;
    row.line = i + 2;
    row.axes = {0.2 + 0.01 * i};
    commanded.poses.push_back(row);
    poses.push_back(camera_pose(shifted(Vec3(0.01 * i, 0.01 * (i % 2), 0.01 * (i % 3)))));
  }
  poses[3] = {};
  poses[3].failure = "the targets do not form their triangle";
  const Measurements table = measured_table(commanded, poses);
  ASSERT_EQ(table.poses.size(), 5u);
  EXPECT_TRUE(table.noise_given);
  EXPECT_EQ(table.poses[3].line, 6);
  EXPECT_EQ(table.poses[3].axes, std::vector<double>{0.2 + 0.01 * 4});
  EXPECT_NEAR(table.poses[3].X_WT.translation().x(), 0.04, 1e-12);
  ASSERT_TRUE(table.frame);
  EXPECT_NEAR(table.frame->position, 5e-6 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(table.frame->rotation, 0, 1e-9);
  for (const MeasuredPose& pose : table.poses)
    EXPECT_TRUE(pose.covariance.isApprox(4e-12 * Mat6::Identity(), 1e-6)) << pose.covariance;
}

TEST(CameraPoses, OfFailedPosesAloneTheTableIsEmpty) {
  Measurements commanded;
  commanded.poses.resize(1);
  CameraPose failed;
  failed.failure = "no";
  EXPECT_TRUE(measured_table(commanded, {failed}).poses.empty());
}

}  // namespace
}  // namespace understudy::calibration

#include "drivers/pose_words.h"

#include <span>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::drivers {
namespace {

TEST(PoseWords, AreRollPitchAndYawAboutFixedAxes) {
  // R = Rz(30) Ry(20) Rx(10), multiplied out by hand.
  Mat3 R;
  R << 0.813797681, -0.440969611, 0.378522306, 0.469846310, 0.882564119, 0.018028311, -0.342020143,
      0.163175911, 0.925416578;
  const auto words = pose_words(make_pose(R, Vec3(1, 2, 3)));
  EXPECT_NEAR(words[0], 1, 1e-15);
  EXPECT_NEAR(words[2], 3, 1e-15);
  EXPECT_NEAR(to_deg(words[3]), 10, 1e-6);
  EXPECT_NEAR(to_deg(words[4]), 20, 1e-6);
  EXPECT_NEAR(to_deg(words[5]), 30, 1e-6);
}

TEST(PoseWords, FollowTheAxesAndJointsAreLongerByTheDeviation) {
  const auto machine = machine::load_machine("hexapod");
  PoseWords words(machine);
  const auto mechanism = machine.make_mechanism();
  Pose X = machine.X_BT_home;
  X.translation() += Vec3(5e-3, -3e-3, 2e-3);
  machine::AxisVector axes{};
  ASSERT_EQ(mechanism->inverse(X, {}, std::span(axes).first(6)), kinematics::SolveStatus::ok);
  const auto found = words.of_axes(axes);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[static_cast<std::size_t>(i)], X.translation()[i], 1e-12);
  // Base joint 1 to ball joint 1: 15 mm beside the screw's axis.
  const auto& g = machine.hexapod().geometry;
  const double distance = (g.base_joint[0] - X * g.platform_joint[0]).norm();
  EXPECT_NEAR(words.joints_of_axes(axes)[0], distance, 1e-15);
  EXPECT_NEAR(words.axes_of_joints(words.joints_of_axes(axes))[0], axes[0], 1e-15);
  EXPECT_FALSE(words.lost());
  axes[0] = 5;
  EXPECT_EQ(words.of_axes(axes), found);
  EXPECT_TRUE(words.lost());
}

TEST(PoseWords, AreOfAHexapodAlone) { EXPECT_THROW(PoseWords{machine::load_machine("arm")}, InputError); }

}  // namespace
}  // namespace understudy::drivers

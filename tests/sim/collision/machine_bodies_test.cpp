#include "sim/collision/machine_bodies.h"

#include <gtest/gtest.h>

#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

TEST(MachineBodies, StrutsRunFromBaseJointToBallJointOfTheGivenGeometry) {
  const auto machine = test::hexapod();
  auto geometry = machine.hexapod().geometry;
  geometry.base_joint[2] += Vec3(0.4e-3, -0.3e-3, 0.2e-3);
  geometry.platform_joint[4] -= Vec3(0.1e-3, 0.2e-3, 0.3e-3);
  const Pose X_WT = make_pose(exp_rotation(Vec3(0.2, -0.1, 0.05)), Vec3(5e-3, -3e-3, 0.06));
  const auto bodies = hexapod_bodies(machine, geometry, X_WT);
  ASSERT_EQ(bodies.size(), 9u);
  for (std::size_t i = 0; i < 6; ++i) {
    const geometry::Shape& strut = bodies[3 + i];
    EXPECT_EQ(strut.name, "strut " + std::to_string(i + 1));
    const auto& capsule = std::get<geometry::Capsule>(strut.form);
    EXPECT_EQ(capsule.radius, machine.hexapod().strut_radius);
    const Vec3 a = strut.X_FS * Vec3(0, 0, -capsule.length / 2),
               b = strut.X_FS * Vec3(0, 0, capsule.length / 2);
    const Vec3 base = machine.X_WB * geometry.base_joint[i], ball = X_WT * geometry.platform_joint[i];
    // Rounding of a quaternion's rotation over 0.2 m.
    EXPECT_LT(std::min((a - base).norm() + (b - ball).norm(), (a - ball).norm() + (b - base).norm()), 1e-14);
  }
}

TEST(MachineBodies, ToolBodiesFollowTheTool) {
  const auto machine = test::hexapod();
  const Pose X_WT = make_pose(exp_rotation(Vec3(0.2, -0.1, 0.05)), Vec3(5e-3, -3e-3, 0.06));
  const auto bodies = hexapod_bodies(machine, machine.hexapod().geometry, X_WT);
  EXPECT_EQ(bodies[0].name, "nozzle");
  EXPECT_EQ(bodies[2].name, "platform");
  EXPECT_LT((bodies[1].X_FS.translation() - X_WT * Vec3(0, 0, 17e-3)).norm(), 1e-15);
  EXPECT_LT((bodies[1].X_FS.linear() - X_WT.linear()).norm(), 1e-15);
}

}  // namespace
}  // namespace understudy::sim

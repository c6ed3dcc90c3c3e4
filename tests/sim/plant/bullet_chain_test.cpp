// Arms in Bullet: a pendulum by hand, and what the frames of the engine say of the tool.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/plant.h"

namespace understudy::sim {
namespace {

constexpr double kMass = 2, kArm = 0.3;  // [kg], [m]

/// Two level axes along y, 0.2 m apart; the second carries a mass 0.3 m out along x.
machine::MachineDescription level_arm() {
  machine::MachineDescription machine;
  machine.name = "level arm";
  auto& model = machine.model.emplace<machine::ChainModel>();
  kinematics::ChainAxis shoulder{"shoulder", true, Vec3::UnitY(), Vec3::Zero(), -1, -3, 3};
  kinematics::ChainAxis elbow{"elbow", true, Vec3::UnitY(), Vec3(0.2, 0, 0), 0, -3, 3};
  model.kinematics.chain.axes = {shoulder, elbow};
  model.kinematics.chain.tool_axis = 1;
  model.kinematics.chain.X_OT_zero = make_pose(Quat::Identity(), Vec3(0.5, 0, 0));
  model.kinematics.home = {0, 0};
  machine::Link upper, fore;
  upper.mass = 1;
  upper.centre_O = Vec3(0.1, 0, 0);
  upper.inertia_O = Vec3(1e-4, 3e-3, 3e-3).asDiagonal();
  fore.mass = kMass;
  fore.centre_O = Vec3(0.2 + kArm, 0, 0);
  fore.inertia_O = Vec3(1e-4, 2e-3, 2e-3).asDiagonal();
  model.links = {upper, fore};
  model.play = {0, 1e-3};
  model.friction = {0, 0};
  for (machine::Drive& drive : machine.drives) drive.velocity_max = 1;
  return machine;
}

TEST(BulletChain, DrivesHoldTheMomentsOfTheWeight) {
  const auto machine = level_arm();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  BulletOptions options;
  options.play = false;
  const auto plant = make_bullet_plant(machine, built, options);
  // About +y a weight at +x turns down: the drives push against it, along -y.
  EXPECT_NEAR(plant->drive_force()[1], -kMass * kGravity * kArm, 1e-6);
  EXPECT_NEAR(plant->drive_force()[0], -kGravity * (kMass * (0.2 + kArm) + 0.1), 1e-6);
}

TEST(BulletChain, GravityTakesAnAxisToTheEndOfItsPlay) {
  const auto machine = level_arm();
  const auto plant = make_bullet_plant(machine, make_as_built(machine, "nominal", 1));
  // Half a milliradian on 0.3 m. 0.1 %: the stop's rest position.
  EXPECT_NEAR(plant->tool_pose().translation().z(), -kArm * std::sin(0.5e-3), 1e-3 * kArm * 0.5e-3);
}

TEST(BulletChain, ToolIsWhereTheChainOfScrewsPutsIt) {
  auto machine = level_arm();
  machine.X_WB = make_pose(exp_rotation(Vec3(0, 0, 0.7)), Vec3(0.3, -0.1, 0.2));
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.axis_play.fill(0);
  built.axis_zero[0] = 0.02;
  built.axis_zero[1] = -0.01;
  const auto plant = make_bullet_plant(machine, built);
  plant->reset({0.4, -0.9});
  const double axes[] = {0.42, -0.91};
  const Pose expected = machine.X_WB * kinematics::forward(built.chain, axes);
  EXPECT_LE((plant->tool_pose().matrix() - expected.matrix()).norm(), 1e-9);
  EXPECT_NEAR(plant->displacement()[0], 0.4, 1e-12);
}

TEST(BulletChain, ReleasedAxisSwingsAsAPhysicalPendulum) {
  auto machine = level_arm();
  machine.chain().play = {0, 0};
  const auto plant = make_bullet_plant(machine, make_as_built(machine, "nominal", 1));
  AxisCondition off;
  off.released = true;
  plant->set_condition(1, off);
  // Energy: from level to hanging, omega^2 I / 2 = m g r, whatever the time that it took.
  double lowest = 0, fastest = 0, angle = 0;
  for (int k = 0; k < 1000 && angle < 1.57; ++k) {
    const double before = angle;
    plant->step({});
    const Vec3 out = plant->tool_pose().linear().col(0);
    angle = std::atan2(-out.z(), out.x());
    fastest = (angle - before) / plant->timestep();
    lowest = plant->tool_pose().translation().z();
  }
  const double inertia = 2e-3 + kMass * kArm * kArm;
  EXPECT_NEAR(lowest, -kArm, 1e-6);
  // 0.2 %: a semi-implicit step of 0.5 ms, and the last 0.8 mrad.
  EXPECT_NEAR(fastest * fastest, 2 * kMass * kGravity * kArm / inertia, 0.004 * 65);
}

TEST(BulletChain, ElasticDriveSagsByItsLoadOverItsStiffness) {
  auto machine = level_arm();
  machine.drives[1].stiffness = 5000;
  machine.drives[1].resonance = 60;
  machine.drives[1].damping_ratio = 0.3;
  machine.drives[1].lead = 0.1;
  machine.drives[1].steps_per_turn = 10;
  machine.chain().play = {0, 0};
  const auto plant = make_bullet_plant(machine, make_as_built(machine, "nominal", 1));
  const double sag = kMass * kGravity * kArm / 5000;
  EXPECT_NEAR(plant->displacement()[1], sag, 1e-3 * sag);  // the load turns by the sag: 1e-6 of it
}

TEST(BulletChain, TableThatMovesIsRefused) {
  auto machine = level_arm();
  machine.chain().kinematics.chain.work_axis = 0;
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  EXPECT_THAT([&] { make_bullet_plant(machine, built); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("'shoulder' carries the work")));
}

}  // namespace
}  // namespace understudy::sim

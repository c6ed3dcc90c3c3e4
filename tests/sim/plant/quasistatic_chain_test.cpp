// The quasistatic chain against closed forms of a two-axis arm and of a table that moves under a fixed tool.
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::sim {
namespace {

constexpr double kUpper = 0.4, kFore = 0.3;          // [m], lengths
constexpr double kUpperMass = 2.0, kForeMass = 1.5;  // [kg], at the middle of each
constexpr double kPlay = 1e-3;                       // [rad]

/// Two axes about -y, stretched along x at zero: positive lifts. The tip is the end.
machine::MachineDescription planar_arm() {
  machine::MachineDescription m;
  m.name = "planar arm";
  m.mechanism = "chain";
  machine::ChainModel chain;
  kinematics::ChainAxis shoulder, elbow;
  shoulder.name = "shoulder";
  shoulder.direction = elbow.direction = -Vec3::UnitY();
  elbow.name = "elbow";
  elbow.point = Vec3(kUpper, 0, 0);
  elbow.parent = 0;
  chain.kinematics.kind = "chain";
  chain.kinematics.chain.axes = {shoulder, elbow};
  chain.kinematics.chain.tool_axis = 1;
  chain.kinematics.chain.X_OT_zero.translation() = Vec3(kUpper + kFore, 0, 0);
  chain.kinematics.home = {0, 0};
  chain.links.resize(2);
  chain.links[0].mass = kUpperMass;
  chain.links[0].centre_O = Vec3(kUpper / 2, 0, 0);
  chain.links[1].mass = kForeMass;
  chain.links[1].centre_O = Vec3(kUpper + kFore / 2, 0, 0);
  chain.play = {kPlay, kPlay};
  chain.friction = {0, 0};
  m.model = chain;
  return m;
}

kinematics::AxisVector pose_of(double shoulder, double elbow) {
  kinematics::AxisVector axes{};
  axes[0] = shoulder;
  axes[1] = elbow;
  return axes;
}

TEST(QuasistaticChain, TorqueIsMassTimesGravityTimesLever) {
  const auto machine = planar_arm();
  QuasistaticOptions options;
  options.play = false;
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1), options);
  for (const double a : {0.0, 0.7, -1.2, 2.5}) {
    const double b = 0.5 - a / 3;
    plant->reset(pose_of(a, b));
    const double elbow = kForeMass * kGravity * kFore / 2 * std::cos(a + b);
    const double shoulder = elbow + (kForeMass * kUpper + kUpperMass * kUpper / 2) * kGravity * std::cos(a);
    EXPECT_NEAR(plant->drive_force()[1], elbow, 1e-12);
    EXPECT_NEAR(plant->drive_force()[0], shoulder, 1e-12);
  }
}

TEST(QuasistaticChain, SpinningArmPullsOnTheElbowOnly) {
  // Stretched and turning at a constant rate without gravity, the elbow bent by 90 degrees: the forearm's
  // centrifugal force m w^2 r has the lever of the bend.
  const auto machine = planar_arm();
  QuasistaticOptions options;
  options.gravity = options.play = false;
  QuasistaticSampler sampler(machine, make_as_built(machine, "nominal", 1), options);
  PathSample sample;
  sample.position = pose_of(0.3, std::numbers::pi / 2);
  sample.velocity[0] = 2;
  Pose X_WT;
  ASSERT_EQ(sampler.sample(sample, X_WT), kinematics::SolveStatus::ok);
  EXPECT_NEAR(sampler.drive_force()[1], kForeMass * 4 * kUpper * kFore / 2, 1e-12);
  EXPECT_NEAR(sampler.drive_force()[0], 0, 1e-12);
}

TEST(QuasistaticChain, PlayHangsDownByHalfInEveryAxis) {
  const auto machine = planar_arm();
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1));
  EXPECT_NEAR(plant->tool_pose().translation().z(), -kUpper * std::sin(kPlay / 2) - kFore * std::sin(kPlay),
              1e-12);
  plant->reset(
      pose_of(0, std::numbers::pi));  // folded back beyond the shoulder's mass: it hangs all the same
  EXPECT_GT(plant->drive_force()[0], 0);
  EXPECT_LT(plant->drive_force()[1], 0);
}

TEST(QuasistaticChain, AgreesWithMujocoAtRest) {
  auto machine = planar_arm();
  for (machine::Link& link : machine.chain().links) link.inertia_O = 0.01 * Mat3::Identity();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto peer = make_mujoco_plant(machine, built);
  const auto plant = make_quasistatic_plant(machine, built);
  peer->reset(pose_of(0.4, 0.6));
  plant->reset(pose_of(0.4, 0.6));
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(plant->drive_force()[i], peer->drive_force()[i], 0.01 * peer->drive_force()[i]);
  // Soft stops of the engine yield by 0.1 um and less.
  EXPECT_LE((plant->tool_pose().translation() - peer->tool_pose().translation()).norm(), 1e-6);
}

TEST(QuasistaticChain, MovingWorkTakesTheNozzlesReaction) {
  // The work on a vertical slide, the tool fixed: the slide carries weight and the nozzle's push.
  machine::MachineDescription machine = planar_arm();
  machine::ChainModel& model = machine.chain();
  kinematics::ChainAxis lift;
  lift.name = "z";
  lift.angle = false;
  model.kinematics.chain = {};
  model.kinematics.chain.axes = {lift};
  model.kinematics.chain.work_axis = 0;
  model.kinematics.home = {0};
  model.links.resize(1);
  model.play = {1e-4};
  model.friction = {0};
  QuasistaticOptions options;
  options.nozzle_force_T = Vec3(0, 0, 3);  // on the tip, upwards
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1), options);
  EXPECT_NEAR(plant->drive_force()[0], kUpperMass * kGravity + 3, 1e-12);
  // The table hangs low by half the play, so the tip seen from it is high.
  EXPECT_NEAR(plant->tool_pose().translation().z(), 0.5e-4, 1e-15);
}

}  // namespace
}  // namespace understudy::sim

// The Bullet plant against kinematics, statics and closed forms of play.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "core/error.h"
#include "kinematics/hexapod/hexapod_passive_rotation.h"
#include "sim/plant/plant.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

using kinematics::kStruts;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

BulletOptions without_play() {
  BulletOptions options;
  options.play = false;
  return options;
}

AsBuilt with_play(const machine::MachineDescription& machine, double total) {
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.nut_play.fill(total * 2 / 3);
  built.ball_play.fill(total / 3);
  return built;
}

/// u_z: all struts of G4 have the same slope on the machine's axis.
double slope(const machine::MachineDescription& machine) {
  const Vec3 d = machine.X_BT_home * machine.hexapod().geometry.platform_joint[0] -
                 machine.hexapod().geometry.base_joint[0];
  return std::abs(d.z()) / d.norm();
}

TEST(BulletPlant, FollowsTheTiltedCircle) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", 3);
  const auto plant = make_bullet_plant(machine, built, without_play());
  const Circle circle = tilted_circle(machine);
  plant->reset(circle_command(built.hexapod, circle, 0).position);
  double closure = 0, tip = 0;
  for (int k = 0; k < steps_for(*plant, 1.0); ++k) {
    plant->step(circle_command(built.hexapod, circle, k * plant->timestep()));
    const Pose X_WT = machine.X_WB * circle.pose((k + 1) * plant->timestep());
    closure = std::max(closure, plant->closure_error());
    tip = std::max(tip, (plant->tool_pose().translation() - X_WT.translation()).norm());
  }
  // docs/reference.md#bullet: 0.036 um at 200 sweeps of Gauss-Seidel, on another geometry.
  EXPECT_LE(closure, 0.1e-6);
  EXPECT_LE(tip, 0.3e-6);  // as the MuJoCo plant
}

TEST(BulletPlant, StrutsCarryTheWeight) {
  auto machine = machine_g4();
  machine.hexapod().masses.motor = 1e-6;  // the platform carries all that the struts hold
  const auto plant = make_bullet_plant(machine, make_as_built(machine, "nominal", 1), without_play());
  Pose X_BT = machine.X_BT_home;
  X_BT.linear() = exp_rotation(from_deg(15) * Vec3(0.6, 0.8, 0));
  plant->reset(drive_command(machine.hexapod().geometry, X_BT).position);
  // J^T f + W = 0; a nut hangs in the ball joint, so its weight is the platform's.
  Twist wrench = Twist::Zero();
  const auto add = [&](double mass, const Vec3& p_T) {
    const Vec3 weight(0, 0, -kGravity * mass);
    wrench.head<3>() += weight;
    wrench.tail<3>() += (X_BT.linear() * p_T).cross(weight);
  };
  add(machine.hexapod().masses.platform, machine.hexapod().masses.platform_centre_T);
  for (const Vec3& ball : machine.hexapod().geometry.platform_joint) add(machine.hexapod().masses.nut, ball);
  Mat6 J;
  ASSERT_EQ(kinematics::jacobian(machine.hexapod().geometry, X_BT, J), kinematics::SolveStatus::ok);
  const Twist expected = -J.transpose().partialPivLu().solve(wrench);
  const auto force = plant->drive_force();
  // 0.2 mN: what six motors of 1 mg weigh, and what creeps at 1 um/s.
  for (int i = 0; i < kStruts; ++i) EXPECT_NEAR(force[static_cast<std::size_t>(i)], expected(i), 2e-4);
}

TEST(BulletPlay, TipJumpsByThePlayWhenTheLoadReverses) {
  auto machine = machine_g4();
  const AsBuilt built = with_play(machine, 100e-6);
  const auto at_rest = [&] {
    const auto plant = make_bullet_plant(machine, built);
    return (machine.X_WB.inverse() * plant->tool_pose()).translation().z();
  };
  const double hanging = at_rest();
  machine.X_WB = machine.X_WB * make_pose(exp_rotation(Vec3(std::numbers::pi, 0, 0)), Vec3::Zero());
  const double standing = at_rest();
  EXPECT_NEAR(standing - hanging, 100e-6 / slope(machine), 0.005 * 100e-6);  // 0.5 %: docs/reference.md#play
}

TEST(BulletPlay, LoopWidthWithoutGravityIsThePlayOverTheSlope) {
  // Nothing but inertia loads the struts: pushed while the platform gains speed, pulled while it loses it.
  const auto machine = machine_g4();
  const AsBuilt built = with_play(machine, 75e-6);
  BulletOptions options;
  options.gravity = false;
  const auto plant = make_bullet_plant(machine, built, options);
  const auto lead_after = [&](double acceleration) {
    plant->reset(drive_command(built.hexapod, machine.X_BT_home).position);
    const int steps = steps_for(*plant, 0.1);
    double z = 0;
    for (int k = 0; k <= steps; ++k) {
      const double t = k * plant->timestep();
      Pose X_BT = machine.X_BT_home;
      z = X_BT.translation().z() + acceleration * t * t / 2;
      X_BT.translation().z() = z;
      if (k == steps) break;
      Twist twist = Twist::Zero();
      twist(2) = acceleration * t;
      plant->step(drive_command(built.hexapod, X_BT, twist));
    }
    return (machine.X_WB.inverse() * plant->tool_pose()).translation().z() - z;
  };
  // 1 %: the project's figure; the pose moves by 10 mm meanwhile, which changes u_z by less.
  EXPECT_NEAR(lead_after(-2) - lead_after(2), 75e-6 / slope(machine), 0.01 * 75e-6);
}

TEST(BulletPlay, FrictionHoldsThePlatformWithinThePlay) {
  // Each strut carries 1.8 N: friction above that keeps it where the machine was assembled, in the middle.
  auto machine = machine_g4();
  machine.hexapod().play.friction = 4;
  const auto held = make_bullet_plant(machine, with_play(machine, 100e-6));
  EXPECT_NEAR(held->tool_pose().translation().z(), from_mm(50), 0.1e-6);
  machine.hexapod().play.friction = 0.5;
  const auto fallen = make_bullet_plant(machine, with_play(machine, 100e-6));
  EXPECT_NEAR(from_mm(50) - fallen->tool_pose().translation().z(), 50e-6 / slope(machine), 0.5e-6);
}

TEST(BulletPlant, GrowthOfAllStrutsLowersTheTip) {
  const auto machine = machine_g4();
  const auto plant = make_bullet_plant(machine, with_play(machine, 50e-6));
  const DriveCommand home = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  const double before = plant->tool_pose().translation().z();
  AxisCondition warm;
  warm.growth = 20e-6;
  for (int i = 0; i < kStruts; ++i) plant->set_condition(i, warm);
  for (int k = 0; k < steps_for(*plant, 0.3); ++k) plant->step(home);
  EXPECT_NEAR(before - plant->tool_pose().translation().z(), 20e-6 / slope(machine), 0.2e-6);
  for (std::size_t i = 0; i < kStruts; ++i)
    EXPECT_NEAR(plant->displacement()[i], home.position[i], 1e-9);  // encoders do not see it
}

TEST(BulletPlant, LooseNutLetsTheTipSinkByHalfItsPlay) {
  const auto machine = machine_g4();
  const auto plant = make_bullet_plant(machine, with_play(machine, 50e-6));
  const DriveCommand home = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  const double before = plant->tool_pose().translation().z();
  AxisCondition loose;
  loose.play_added = 60e-6;
  for (int i = 0; i < kStruts; ++i) plant->set_condition(i, loose);
  for (int k = 0; k < steps_for(*plant, 0.3); ++k) plant->step(home);
  EXPECT_NEAR(before - plant->tool_pose().translation().z(), 30e-6 / slope(machine), 0.3e-6);
}

TEST(BulletPlant, ReleasedDriveStaysWhenItLocksItself) {
  auto machine = machine_g4();
  machine.drives[2].self_locking = true;
  const auto plant = make_bullet_plant(machine, with_play(machine, 50e-6));
  const double held = plant->displacement()[2];
  AxisCondition off;
  off.released = true;
  plant->set_condition(2, off);
  Pose X_BT = machine.X_BT_home;
  X_BT.translation().z() -= from_mm(0.2);
  const DriveCommand lower = drive_command(machine.hexapod().geometry, X_BT);
  DriveCommand command = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  for (int k = 0; k < steps_for(*plant, 0.2); ++k) {
    for (std::size_t i = 0; i < kStruts; ++i)
      command.position[i] += (lower.position[i] - command.position[i]) * 0.02;
    plant->step(command);
  }
  EXPECT_NEAR(plant->displacement()[2], held, 1e-12);
  EXPECT_NEAR(plant->displacement()[1], lower.position[1], 1e-6);
}

TEST(BulletPlant, TurningScrewsMoveTheTipAsKinematicsSays) {
  auto machine = machine_g4();
  machine.hexapod().screw_rotation = machine::ScrewRotation::free;
  for (machine::Drive& drive : machine.drives) drive.lead = from_mm(1.5875);
  ASSERT_GT(machine.screw_coupling().lead, 0);
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto plant = make_bullet_plant(machine, built, without_play());
  Pose X_BT = machine.X_BT_home;
  X_BT.linear() = exp_rotation(from_deg(12) * Vec3(0.6, 0.8, 0));
  X_BT.translation() += Vec3(0.008, -0.005, -0.01);
  kinematics::StrutLengths lengths{};
  ASSERT_EQ(kinematics::inverse(built.hexapod, machine.screw_coupling(), X_BT, lengths),
            kinematics::SolveStatus::ok);
  const kinematics::AxisVector start = plant->displacement();
  for (int k = 1; k <= steps_for(*plant, 0.4); ++k) {
    const double s = std::min(1.0, k * plant->timestep() / 0.3), blend = s * s * s * (10 + s * (6 * s - 15)),
                 rate = 30 * s * s * (1 - s) * (1 - s) / 0.3;
    DriveCommand command;
    for (std::size_t i = 0; i < kStruts; ++i) {
      const double travel = lengths[i] - built.hexapod.length_offset[i] - start[i];
      command.position[i] = start[i] + blend * travel;
      command.velocity[i] = rate * travel;
    }
    plant->step(command);
  }
  // Without the turning the tip would be off by lead / 2 pi times 0.1 rad: 25 um.
  EXPECT_LE((plant->tool_pose().translation() - machine.X_WB * X_BT.translation()).norm(), 0.3e-6);
}

TEST(BulletPlant, ResetGivesTheSameBytesAgain) {
  const auto machine = machine_g4();
  const AsBuilt built = with_play(machine, 75e-6);
  const Circle circle = tilted_circle(machine);
  const auto run = [&](Plant& plant) {
    plant.reset(circle_command(built.hexapod, circle, 0).position);
    for (int k = 0; k < 300; ++k) plant.step(circle_command(built.hexapod, circle, k * plant.timestep()));
    return plant.tool_pose().matrix().eval();
  };
  const auto plant = make_bullet_plant(machine, built), other = make_bullet_plant(machine, built);
  const auto first = run(*plant);
  EXPECT_EQ(run(*plant), first);
  EXPECT_EQ(run(*other), first);
}

TEST(BulletFailure, IsAnErrorWithPlaceAndTimeAndLastsUntilReset) {
  const auto machine = machine_g4();
  const auto plant = make_bullet_plant(machine, with_play(machine, 75e-6));
  const DriveCommand home = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  DriveCommand jump = home;
  jump.position[3] += from_mm(100);
  plant->step(home);
  EXPECT_THAT([&] { plant->step(jump); },
              ThrowsMessage<MachineError>(HasSubstr("engine failure at 0.0005 s")));
  EXPECT_THROW(plant->step(home), MachineError);
  plant->reset(home.position);
  EXPECT_NO_THROW(plant->step(home));
  DriveCommand bad = home;
  bad.velocity[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { plant->step(bad); }, ThrowsMessage<MachineError>(HasSubstr("drive 2")));
  auto impossible = home.position;
  impossible[0] += from_mm(400);
  EXPECT_THAT([&] { plant->reset(impossible); }, ThrowsMessage<MachineError>(HasSubstr("cannot be closed")));
  for (const double timestep : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN()}) {
    BulletOptions options;
    options.timestep = timestep;
    EXPECT_THROW(make_bullet_plant(machine, with_play(machine, 0), options), InputError);
  }
}

}  // namespace
}  // namespace understudy::sim

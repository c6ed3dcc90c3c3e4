// What every quasistatic plant promises: errors, conditions, determinism, no allocation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "core/error.h"
#include "kinematics/hexapod/hexapod_passive_rotation.h"
#include "sim/plant/quasistatic/quasistatic.h"
#include "tests/guard/cycle_guard.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(QuasistaticPlant, RefusesImpossibleOptions) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  QuasistaticOptions options;
  options.timestep = 0;
  EXPECT_THROW(make_quasistatic_plant(machine, built, options), InputError);
  options.timestep = 1e-3;
  options.nozzle_force_T.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_quasistatic_plant(machine, built, options), InputError);
}

TEST(QuasistaticPlant, FailsLoudlyAndStaysFailedUntilReset) {
  const auto machine = machine_g4();
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1));
  const DriveCommand home = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  DriveCommand bad = home;
  bad.position[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of([&] { plant->step(bad); }), HasSubstr("drive 3"));
  EXPECT_THAT(message_of([&] { plant->step(home); }), HasSubstr("not reset"));
  plant->reset(home.position);
  plant->step(home);
  bad = home;
  bad.position[0] = -0.15;  // a strut of 20 mm
  EXPECT_THAT(message_of([&] { plant->step(bad); }), HasSubstr("cannot be closed"));
  EXPECT_THROW(plant->reset(bad.position), MachineError);
}

TEST(QuasistaticPlant, PoseIsTheCommandsAtTheStepsEnd) {
  const auto machine = machine_g4();
  QuasistaticOptions options;
  options.play = false;
  const AsBuilt built = make_as_built(machine, "sampled", 5);
  const auto plant = make_quasistatic_plant(machine, built, options);
  const Circle circle = tilted_circle(machine);
  plant->reset(circle_command(built.hexapod, circle, 0).position);
  for (int k = 0; k < steps_for(*plant, 1); ++k) {
    plant->step(circle_command(built.hexapod, circle, k * plant->timestep()));
    EXPECT_NEAR(plant->time(), (k + 1) * plant->timestep(), 1e-12);
    const Vec3 due = machine.X_WB * circle.pose(plant->time()).translation();
    // Half the jump of the acceleration over a step at the ends of the ramp: 63 mm/s / 0.5 s * (2 ms)^2.
    ASSERT_LE((plant->tool_pose().translation() - due).norm(), 0.6e-6) << k;
  }
}

TEST(QuasistaticPlant, SelfLockingDriveStaysWhereItWasReleased) {
  auto machine = machine_g4();
  machine.drives[1].self_locking = true;
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1));
  DriveCommand command = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  plant->reset(command.position);
  AxisCondition released;
  released.released = true;
  plant->set_condition(1, released);
  for (double& p : command.position) p += 0.1e-3;
  plant->step(command);
  EXPECT_NEAR(plant->displacement()[1], command.position[1] - 0.1e-3, 1e-12);
  EXPECT_NEAR(plant->displacement()[2], command.position[2], 1e-12);
  EXPECT_THAT(
      message_of([&] { plant->set_condition(3, released); }),
      HasSubstr("strut 4 is released and not self-locking: quasistatic cannot play an axis that falls"));
}

TEST(QuasistaticPlant, GrowthMovesTheToolAndNotTheReading) {
  const auto machine = machine_g4();
  QuasistaticOptions options;
  options.play = false;
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1), options);
  const DriveCommand command = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  plant->reset(command.position);
  AxisCondition warm;
  warm.growth = 40e-6;
  plant->set_condition(0, warm);
  plant->step(command);
  const DriveCommand reached =
      drive_command(machine.hexapod().geometry, machine.X_WB.inverse() * plant->tool_pose());
  EXPECT_NEAR(reached.position[0] - command.position[0], 40e-6, 1e-11);
  EXPECT_NEAR(reached.position[1] - command.position[1], 0, 1e-11);
  EXPECT_NEAR(plant->displacement()[0], command.position[0], 1e-12);
}

TEST(QuasistaticPlant, LooseNutLetsItsStrutLonger) {
  const auto machine = machine_g4();
  const auto plant = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1));
  const DriveCommand command = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  plant->reset(command.position);
  const auto length = [&] {
    return drive_command(machine.hexapod().geometry, machine.X_WB.inverse() * plant->tool_pose()).position[4];
  };
  const double before = length();
  AxisCondition loose;
  loose.play_added = 80e-6;
  plant->set_condition(4, loose);
  plant->step(command);
  EXPECT_LT(length() - before, 20e-6);  // 2 ms of falling with 1/6 of the weight: it takes time
  for (int k = 0; k < steps_for(*plant, 0.2); ++k) plant->step(command);
  EXPECT_NEAR(length() - before, 40e-6, 1e-9);  // pulled to the new end
  loose.play_added = -1e-3;
  EXPECT_THROW(plant->set_condition(4, loose), InputError);
  EXPECT_THROW(plant->set_condition(6, {}), InputError);
}

TEST(QuasistaticPlant, SameCommandsGiveTheSameBytes) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", 9);
  const Circle circle = tilted_circle(machine);
  const auto run = [&] {
    const auto plant = make_quasistatic_plant(machine, built);
    plant->reset(circle_command(built.hexapod, circle, 0).position);
    std::vector<double> trace;
    for (int k = 0; k < 500; ++k) {
      plant->step(circle_command(built.hexapod, circle, k * plant->timestep()));
      const Pose X_WT = plant->tool_pose();
      trace.insert(trace.end(), X_WT.data(), X_WT.data() + X_WT.matrix().size());
      trace.push_back(plant->drive_force()[3]);
    }
    return trace;
  };
  EXPECT_EQ(run(), run());
}

TEST(QuasistaticPlant, StepAndSampleDoNotAllocate) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const Circle circle = tilted_circle(machine);  // crosses plays
  const auto plant = make_quasistatic_plant(machine, built);
  QuasistaticSampler sampler(machine, built);
  std::vector<DriveCommand> commands;
  for (int k = 0; k < 1000; ++k)
    commands.push_back(circle_command(built.hexapod, circle, k * plant->timestep()));
  plant->reset(commands.front().position);
  double watched = 0;
  int solved = 0;
  const Calls before = calls();
  for (const DriveCommand& command : commands) {
    plant->step(command);
    Pose X_WT = Pose::Identity();
    solved += sampler.sample({command.position, command.velocity, {}}, X_WT) == kinematics::SolveStatus::ok;
    watched += X_WT(0, 3) + plant->tool_pose()(0, 3) + plant->drive_force()[0] + plant->displacement()[0];
  }
  EXPECT_EQ(calls() - before, Calls{}) << watched;
  EXPECT_EQ(solved, 1000);
}

TEST(QuasistaticPlant, ScrewsThatTurnMoveTheToolAsKinematicsSays) {
  auto machine = machine_g4();
  machine.hexapod().screw_rotation = machine::ScrewRotation::free;
  for (machine::Drive& drive : machine.drives) drive.lead = 1.5875e-3;
  QuasistaticOptions options;
  options.play = false;
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto plant = make_quasistatic_plant(machine, built, options);
  Pose X_BT = machine.X_BT_home;
  X_BT.translation() += Vec3(0.012, -0.008, 0.004);
  X_BT.linear() = exp_rotation(Vec3(0.15, 0.1, 0));
  kinematics::StrutLengths lengths{};
  ASSERT_EQ(kinematics::inverse(built.hexapod, machine.screw_coupling(), X_BT, lengths),
            kinematics::SolveStatus::ok);
  DriveCommand command;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    command.position[i] = lengths[i] - built.hexapod.length_offset[i];
  plant->reset(command.position);
  plant->step(command);
  const Vec3 due = machine.X_WB * X_BT.translation();
  EXPECT_LE((plant->tool_pose().translation() - due).norm(), 1e-11);
  EXPECT_GT(std::abs(drive_command(built.hexapod, X_BT).position[0] - command.position[0]),
            1e-6);  // it matters
}

TEST(QuasistaticSampler, SaysWhatHasNoPoseAndGoesOn) {
  const auto machine = machine_g4();
  QuasistaticSampler sampler(machine, make_as_built(machine, "nominal", 1));
  PathSample home, bad;
  home.position = drive_command(machine.hexapod().geometry, machine.X_BT_home).position;
  Pose X_WT = Pose::Identity();
  bad.position.fill(std::numeric_limits<double>::infinity());
  EXPECT_EQ(sampler.sample(bad, X_WT), kinematics::SolveStatus::bad_input);
  bad = home;
  bad.position[0] = -0.15;
  EXPECT_NE(sampler.sample(bad, X_WT), kinematics::SolveStatus::ok);
  EXPECT_TRUE(X_WT.isApprox(Pose::Identity(), 0));
  std::array<PathSample, 3> path{home, bad, home};
  std::array<Pose, 3> poses;
  EXPECT_EQ(sampler.sample(path, poses), 1U);
  EXPECT_EQ(sampler.sample(home, X_WT), kinematics::SolveStatus::ok);
}

TEST(QuasistaticSampler, RestsWhereThePlantRests) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", 4);
  QuasistaticSampler sampler(machine, built);
  const auto plant = make_quasistatic_plant(machine, built);
  PathSample sample;
  Pose X_BT = machine.X_BT_home;
  X_BT.translation() += Vec3(0.01, 0.004, -0.01);
  sample.position = drive_command(built.hexapod, X_BT).position;
  plant->reset(sample.position);
  Pose X_WT;
  ASSERT_EQ(sampler.sample(sample, X_WT), kinematics::SolveStatus::ok);
  EXPECT_LE((X_WT.translation() - plant->tool_pose().translation()).norm(), 1e-10);
}

}  // namespace
}  // namespace understudy::sim

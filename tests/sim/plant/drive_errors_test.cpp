// Screws whose lead is not what the drive believes.
#include "sim/plant/drive_errors.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

constexpr double kLead = 1.5875e-3;  // [m], 1/16 inch
constexpr DriveError kError{0.3e-3, 8e-6, 0.7};

TEST(DriveErrors, ALongScrewGoesFartherAndRepeatsEveryTurn) {
  EXPECT_EQ(axis_travel(kError, kLead, 0), 0);
  for (const int turns : {1, 7, 30})
    EXPECT_NEAR(axis_travel(kError, kLead, turns * kLead), 1.0003 * turns * kLead, 1e-15) << turns;
  // Peak to peak within a turn, of a lead that is right.
  double most = 0, least = 0;
  for (int i = 0; i < 1000; ++i) {
    const double motor = kLead * i / 1000, by = axis_travel({0, 8e-6, 0.7}, kLead, motor) - motor;
    most = std::max(most, by), least = std::min(least, by);
  }
  EXPECT_NEAR(most - least, 16e-6, 1e-9);
}

TEST(DriveErrors, TheMotorIsFoundFromTheAxis) {
  for (int i = -50; i < 50; ++i) {
    const double motor = 1.37e-3 * i;
    EXPECT_NEAR(motor_travel(kError, kLead, axis_travel(kError, kLead, motor)), motor, 1e-14);
  }
}

TEST(DriveErrors, AMachineWithoutThemIsItself) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  auto plant = make_quasistatic_plant(machine, built);
  const Plant* itself = plant.get();
  EXPECT_EQ(with_drive_errors(std::move(plant), machine, built).get(), itself);
}

TEST(DriveErrors, TheToolStandsWhereTheScrewsTrulyAreAndTheMotorsCountTheirOwnTurns) {
  auto machine = machine_g4();
  for (machine::Drive& drive : machine.drives) drive.lead = kLead;
  AsBuilt built = make_as_built(machine, "nominal", 1);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    built.drives[i] = {1e-4 * static_cast<double>(i + 1), 5e-6, 0.4 * static_cast<double>(i)};
  const auto perfect = make_quasistatic_plant(machine, built);
  const auto plant = with_drive_errors(make_quasistatic_plant(machine, built), machine, built);
  const DriveCommand motors = drive_command(machine.hexapod().geometry, machine.X_BT_home);
  DriveCommand screws = motors;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    const double turn = 2 * std::numbers::pi * motors.position[i] / kLead;
    screws.position[i] *= 1 + built.drives[i].scale;
    screws.position[i] += 5e-6 * (std::sin(turn + built.drives[i].phase) - std::sin(built.drives[i].phase));
  }
  plant->reset(motors.position);
  perfect->reset(screws.position);
  plant->step(motors);
  perfect->step(screws);
  EXPECT_LT((plant->tool_pose().translation() - perfect->tool_pose().translation()).norm(), 1e-12);
  perfect->step(motors);
  EXPECT_GT((plant->tool_pose().translation() - perfect->tool_pose().translation()).norm(), 1e-6);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    EXPECT_NEAR(plant->displacement()[i], motors.position[i], 1e-12) << "strut " << i + 1;
}

}  // namespace
}  // namespace understudy::sim

// Drives of open chains in MuJoCo: let go, locked, elastic; closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/plant/plant.h"
#include "tests/sim/plant/small_chains.h"

namespace understudy::sim {
namespace {

constexpr double kPi = std::numbers::pi;

std::unique_ptr<Plant> nominal_plant(const machine::MachineDescription& machine) {
  return make_mujoco_plant(machine, make_as_built(machine, "nominal", 1));
}

AxisCondition released() {
  AxisCondition condition;
  condition.released = true;
  return condition;
}

/// Length of the swings [s] and the largest turn of the last one, of a pendulum let go at `start` from its
/// lowest place.
struct Swing {
  double period = 0, amplitude = 0;
};
Swing swing(double start, double duration) {
  const SmallAxis axis{true, Vec3::UnitY(), {0, 0, 0}, 0.8, {0.15, 0, 0}, 5e-3, kPi / 2 - start};
  const auto machine = small_chain({axis}, {0.3, 0, 0});
  const auto plant = nominal_plant(machine);
  plant->set_condition(0, released());
  std::vector<double> crossings;
  Swing result;
  double before = -start;
  while (plant->time() < duration) {
    plant->step(hold(home_of(machine)));
    const double now = plant->displacement()[0] - kPi / 2;
    if (before < 0 && now >= 0) {
      crossings.push_back(plant->time() - plant->timestep() * now / (now - before));
      result.amplitude = 0;
    }
    result.amplitude = std::max(result.amplitude, now);
    before = now;
  }
  EXPECT_GE(crossings.size(), 3U);
  result.period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  return result;
}

// T = 4 K(sin(a / 2)) sqrt(I / (m g c)). The model keeps a thousandth of the inertia as a rotor: 0.05 %, and
// a semi-implicit step of 0.5 ms some 0.01 %.
TEST(MujocoChainDrives, AnAxisThatIsReleasedSwingsAsAPendulum) {
  for (const double start : {0.1, 1.0}) {
    const double inertia = 5e-3 + 0.8 * 0.15 * 0.15;
    const double expected =
        4 * std::comp_ellint_1(std::sin(start / 2)) * std::sqrt(inertia / (0.8 * kGravity * 0.15));
    const Swing result = swing(start, 4.5);
    EXPECT_NEAR(result.period / expected, 1, 1.5e-3) << start;
    EXPECT_NEAR(result.amplitude / start, 1, 5e-3) << "energy is not kept";
  }
}

TEST(MujocoChainDrives, ASlideThatIsReleasedFalls) {
  SmallAxis axis{false, Vec3::UnitZ(), {0, 0, 0}, 2.0};
  const auto machine = small_chain({axis}, {0, 0, 0});
  const auto plant = nominal_plant(machine);
  plant->set_condition(0, released());
  const double height = plant->tool_pose().translation().z();
  for (int k = 0; k < 400; ++k) plant->step(hold(home_of(machine)));
  // g t^2 / 2 with a thousandth of rotor; a semi-implicit step falls by one step more of 400.
  const double t = 400 * plant->timestep();
  EXPECT_NEAR((height - plant->tool_pose().translation().z()) / (kGravity * t * t / 2), 1, 0.004);
  EXPECT_NEAR(plant->drive_force()[0], 0, 0.03);  // of 19.6 N
}

TEST(MujocoChainDrives, ASelfLockingDriveStaysWhenReleased) {
  for (const bool elastic : {false, true}) {
    auto machine = two_links(0.4, -0.9);
    for (std::size_t i = 0; i < 2; ++i) {
      machine.drives[i].self_locking = true;
      if (elastic) {
        machine.drives[i].stiffness = 1e5;
        machine.drives[i].resonance = 60;
        machine.drives[i].damping_ratio = 0.1;
      }
    }
    const auto plant = nominal_plant(machine);
    const Pose before = plant->tool_pose();
    DriveCommand command = hold(home_of(machine));
    plant->step(command);
    for (int axis = 0; axis < 2; ++axis) plant->set_condition(axis, released());
    command.position.fill(1.0);  // nobody listens
    command.velocity.fill(0.5);
    for (int k = 0; k < 1000; ++k) plant->step(command);
    EXPECT_LT((plant->tool_pose().translation() - before.translation()).norm(), 10e-9) << elastic;
  }
}

TEST(MujocoChainDrives, AnElasticDriveThatWasMovingKeepsNoPushWhenReleased) {
  auto machine = small_chain({{false, Vec3::UnitX(), {0, 0, 0}, 2.0}}, {0, 0, 0});
  machine.drives[0].stiffness = 1e5;
  machine.drives[0].resonance = 40;
  machine.drives[0].damping_ratio = 0.5;
  machine.drives[0].self_locking = true;
  const auto plant = nominal_plant(machine);
  DriveCommand command;
  for (int k = 0; k < 400; ++k) {
    command.position[0] = 0.05 * plant->time();
    command.velocity[0] = 0.05;
    plant->step(command);
  }
  plant->set_condition(0, released());
  for (int k = 0; k < 2000; ++k) plant->step(command);
  EXPECT_NEAR(plant->drive_force()[0], 0, 1e-6);  // nothing pulls on it, so it pushes nothing
  EXPECT_NEAR(plant->displacement()[0], command.position[0], 1e-8);
}

/// A vertical slide with an elastic drive: 1 N/um, the bare motor at 100 Hz.
machine::MachineDescription elastic_slide() {
  SmallAxis axis{false, Vec3::UnitZ(), {0, 0, 0}, 2.0};
  auto machine = small_chain({axis}, {0, 0, 0});
  machine.drives[0].stiffness = 1e6;
  machine.drives[0].resonance = 100;
  machine.drives[0].damping_ratio = 0.01;
  return machine;
}

TEST(MujocoChainDrives, AnElasticDriveSagsByForceOverStiffness) {
  const auto machine = elastic_slide();
  const auto plant = nominal_plant(machine);
  const double sag = 2.0 * kGravity / 1e6;  // 19.6 um
  // At rest after settling: speeds below 1 um/s at 470 rad/s are 2 nm.
  EXPECT_NEAR(plant->displacement()[0], -sag, 5e-9);
  EXPECT_NEAR(plant->tool_pose().translation().z(), -sag, 5e-9);
  plant->step(hold({}));
  EXPECT_NEAR(plant->drive_force()[0], 2.0 * kGravity, 1e-3 * 2.0 * kGravity);
}

TEST(MujocoChainDrives, AnElasticDriveSwingsWithRotorAndLoadTogether) {
  const auto machine = elastic_slide();
  const auto plant = nominal_plant(machine);
  const double rotor = 1e6 / std::pow(2 * kPi * 100, 2);
  EXPECT_NEAR(machine.drives[0].rotor(), rotor, 1e-12);
  const double expected = std::sqrt(1e6 / (rotor + 2.0)) / (2 * kPi);  // [Hz]
  const double rest = plant->displacement()[0] + 10e-6;
  double before = -10e-6;
  std::vector<double> crossings;
  for (int k = 0; k < 400; ++k) {
    plant->step(hold({10e-6}));
    const double now = plant->displacement()[0] - rest;
    if (before < 0 && now >= 0) crossings.push_back(plant->time() - plant->timestep() * now / (now - before));
    before = now;
  }
  ASSERT_GE(crossings.size(), 8U);
  const double frequency = static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
  // A semi-implicit step is off by (omega dt)^2 / 24 = 0.2 %, damping by 0.005 %.
  EXPECT_NEAR(frequency / expected, 1, 0.02);
}

}  // namespace
}  // namespace understudy::sim

// Faults of a whole machine behind its port: where the tool goes, and what the controller learns.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "core/units.h"
#include "sim/as_built/as_built.h"
#include "sim/twin/simulated_port.h"

namespace understudy::sim {
namespace {

using machine::Fault;
using machine::Setpoint;
using machine::Status;
using testing::HasSubstr;

/// A nominal machine behind a port.
struct Rig {
  Rig(const machine::MachineDescription& description, const std::string& engine,
      const std::vector<FaultEvent>& faults)
      : machine(description), built(make_as_built(machine, "nominal", 1)) {
    plant = engine == "mujoco" ? make_mujoco_plant(machine, built) : make_quasistatic_plant(machine, built);
    TwinOptions options;
    options.faults = faults;
    port = std::make_unique<SimulatedPort>(machine, *plant, Exposure(), std::vector<Observer*>{}, options);
    EXPECT_EQ(port->wait_until(0.05), Status::ok);  // on the microsteps that are nearest to home
  }
  Vec3 tip() const { return plant->tool_pose().translation(); }

  machine::MachineDescription machine;
  AsBuilt built;
  std::unique_ptr<Plant> plant;
  std::unique_ptr<SimulatedPort> port;
};

machine::MachineDescription locked(const std::string& name, bool self_locking) {
  auto machine = machine::load_machine(name);
  for (machine::Drive& drive : machine.drives) drive.self_locking = self_locking;
  return machine;
}

/// Axis 1 runs `way` at constant speed within `duration` and rests for as long.
std::vector<Setpoint> run_axis(const SimulatedPort& port, double way, double duration) {
  std::vector<Setpoint> setpoints;
  const kinematics::AxisVector start = port.state().position;
  const int count = static_cast<int>(duration / 1e-3);
  for (int k = 1; k <= 2 * count; ++k) {
    Setpoint s;
    s.time = port.now() + 1e-3 * k;
    s.position = start;
    s.position[0] += way * std::min(1.0, static_cast<double>(k) / count);
    s.velocity[0] = k < count ? way / duration : 0;
    setpoints.push_back(s);
  }
  return setpoints;
}

/// The tip's shift per metre of strut 1: a column of the inverse Jacobian, in W.
Vec3 tip_per_strut(const machine::MachineDescription& machine) {
  Mat6 J;
  EXPECT_EQ(kinematics::jacobian(machine.hexapod().geometry, machine.X_BT_home, J),
            kinematics::SolveStatus::ok);
  return machine.X_WB.linear() * J.inverse().col(0).head<3>();
}

// The next order of the tip's shift: (strut's change)^2 over a lever of the platform, 30 mm; with the growths
// of 0.1 mm here 0.3 um, and MuJoCo's constraints add less than 0.1 um (docs/reference.md#mujoco).
constexpr double kSecondOrder = 0.4e-6;  // [m]

class GrowingStrut : public testing::TestWithParam<const char*> {};

TEST_P(GrowingStrut, ShiftsTheTipByTheInverseJacobian) {
  const double growth = 0.1e-3;
  Rig rig(locked("hexapod", true), GetParam(), {{FaultKind::thermal_growth, 0, 0.1, 0, 0.4, growth}});
  const Vec3 before = rig.tip();
  ASSERT_EQ(rig.port->wait_until(0.3), Status::ok);
  // Half of it, as the ramp of 0.4 s says; a step of the plant is at most 2 ms of it.
  EXPECT_NEAR((rig.tip() - before - growth / 2 * tip_per_strut(rig.machine)).norm(), 0,
              kSecondOrder + growth * 2e-3 / 0.4 * tip_per_strut(rig.machine).norm());
  ASSERT_EQ(rig.port->wait_until(0.7), Status::ok);
  EXPECT_NEAR((rig.tip() - before - growth * tip_per_strut(rig.machine)).norm(), 0, kSecondOrder);
}

TEST_P(GrowingStrut, IsNotSeenByItsDrive) {
  Rig rig(locked("hexapod", true), GetParam(), {{FaultKind::thermal_growth, 0, 0.1, 0, 0.1, 0.1e-3}});
  const auto before = rig.port->state().position;
  ASSERT_EQ(rig.port->wait_until(0.4), Status::ok);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(rig.port->state().position[i], before[i], 0.01e-6);
  EXPECT_EQ(rig.port->state().fault, Fault::none);
}

// Hanging, every strut pulls: the platform's end of a play is its lower one, and half of what a joint gains
// in free travel lengthens the strut.
TEST_P(GrowingStrut, LooseJointLowersItByHalfOfItsPlay) {
  const double added = 0.1e-3;
  Rig rig(locked("hexapod", true), GetParam(), {{FaultKind::loose_joint, 0, 0.1, 0, 0, added}});
  const Vec3 before = rig.tip();
  ASSERT_EQ(rig.port->wait_until(1.0), Status::ok);
  EXPECT_NEAR((rig.tip() - before - added / 2 * tip_per_strut(rig.machine)).norm(), 0, kSecondOrder);
}

INSTANTIATE_TEST_SUITE_P(Engines, GrowingStrut, testing::Values("mujoco", "quasistatic"),
                         [](const auto& one) { return std::string(one.param); });

TEST(LostSteps, ThePortGoesOnCountingWhileTheMachineIsElsewhere) {
  Rig rig(locked("hexapod", true), "quasistatic", {{FaultKind::lost_steps, 0, 0.1, 20}});
  const double before = rig.plant->displacement()[0];
  const auto start = rig.port->state().position;
  const auto setpoints = run_axis(*rig.port, 2e-3, 0.4);
  ASSERT_EQ(rig.port->submit(setpoints, 1), Status::ok);
  ASSERT_EQ(rig.port->wait_until(0.9), Status::ok);
  const auto state = rig.port->state();
  EXPECT_EQ(state.executed, setpoints.size());
  EXPECT_EQ(state.fault, Fault::none);
  const double step = rig.machine.drives[0].step();
  EXPECT_NEAR(state.position[0], start[0] + 2e-3, step / 2);  // the nearest microstep
  const double slip = 20 * rig.machine.drives[0].lead / rig.machine.drives[0].steps_per_turn;
  EXPECT_NEAR(rig.plant->displacement()[0], before + 2e-3 - slip, step / 2);
}

// Catching a cycle of the tilting table's worm is a jump of up to a milliradian.
TEST(Stall, OfACoarseDriveIsNoFailureOfTheEngine) {
  const int b = 3;
  Rig rig(machine::load_machine("five-axis"), "mujoco", {{FaultKind::stall, b, 0.1, 0, 0.05}});
  auto setpoints = run_axis(*rig.port, 0, 0.4);
  const auto start = rig.port->state().position;
  const double rate = 0.5 * rig.machine.drives[b].velocity_max;
  for (std::size_t k = 0; k < setpoints.size(); ++k) {
    setpoints[k].position[0] = start[0];
    setpoints[k].position[b] = start[b] + rate * std::min(0.4, 1e-3 * static_cast<double>(k + 1));
    setpoints[k].velocity[b] = k + 1 < 400 ? rate : 0;
  }
  ASSERT_EQ(rig.port->submit(setpoints, 1), Status::ok);
  EXPECT_EQ(rig.port->wait_until(0.9), Status::ok) << rig.port->engine_failure();
  const double behind = start[b] + 0.4 * rate - rig.plant->displacement()[b];
  const double cycle = 4 * rig.machine.drives[b].lead / rig.machine.drives[b].steps_per_turn;
  // 45 deg/s for 0.05 s: 2.25 degrees of 0.12 degrees a cycle; found to within a microstep.
  EXPECT_NEAR(behind, std::round(0.05 * rate / cycle) * cycle, cycle / 2 + rig.machine.drives[b].step());
  EXPECT_NEAR(behind / cycle, std::round(behind / cycle), rig.machine.drives[b].step() / cycle);
}

TEST(Disconnected, AnAxisThatFallsIsMoreThanTheQuasistaticPlantCanPlayAndItSaysSo) {
  Rig rig(locked("arm", false), "quasistatic", {{FaultKind::disconnected, 1, 0.1}});
  EXPECT_EQ(rig.port->wait_until(0.5), Status::faulted);
  EXPECT_EQ(rig.port->state().fault, Fault::engine);
  EXPECT_THAT(rig.port->engine_failure(), HasSubstr("not self-locking"));
}

TEST(Disconnected, AnArmSagsAboutThatJointAlone) {
  Rig rig(locked("arm", false), "mujoco", {{FaultKind::disconnected, 1, 0.1}});
  const double height = rig.tip().z();
  const auto before = rig.plant->displacement();
  ASSERT_EQ(rig.port->wait_until(0.3), Status::ok) << rig.port->engine_failure();
  EXPECT_LT(rig.tip().z(), height - 10e-3);
  const auto after = rig.plant->displacement();
  EXPECT_GT(after[1], before[1] + from_deg(2));  // forwards and down
  for (const std::size_t i : {0, 2, 3, 4, 5}) EXPECT_NEAR(after[i], before[i], 50e-6) << i;
  EXPECT_EQ(rig.port->state().fault, Fault::none);  // nobody has noticed
}

TEST(PowerCut, AnArmFallsAndAMachineOfScrewsStays) {
  Rig arm(locked("arm", false), "mujoco", {{FaultKind::power_cut, 0, 0.1}});
  const double arm_height = arm.tip().z();
  EXPECT_EQ(arm.port->wait_until(1.0), Status::faulted) << arm.port->engine_failure();
  EXPECT_EQ(arm.port->state().fault, Fault::power);
  EXPECT_LT(arm.tip().z(), arm_height - 100e-3);

  for (const char* engine : {"mujoco", "quasistatic"}) {
    Rig hexapod(locked("hexapod", true), engine, {{FaultKind::power_cut, 0, 0.1}});
    const Vec3 before = hexapod.tip();
    EXPECT_EQ(hexapod.port->wait_until(1.0), Status::faulted);
    EXPECT_EQ(hexapod.port->state().fault, Fault::power);
    // A closed loop's error (docs/reference.md#mujoco).
    EXPECT_LT((hexapod.tip() - before).norm(), 0.1e-6) << engine;
  }
  Rig loose(locked("hexapod", false), "mujoco", {{FaultKind::power_cut, 0, 0.1}});
  const double height = loose.tip().z();
  EXPECT_EQ(loose.port->wait_until(1.0), Status::faulted);
  EXPECT_LT(loose.tip().z(), height - 5e-3);
}

TEST(PowerCut, IsStickyAndEndsThePrintWithAReason) {
  Rig rig(locked("hexapod", true), "quasistatic", {{FaultKind::power_cut, 0, 0.5}});
  toolpath::Program program;
  for (int line = 1; line <= 4; ++line) {
    toolpath::Step step;
    step.kind = toolpath::StepKind::print;
    step.X_WT = rig.machine.X_WB * rig.machine.X_BT_home;
    step.X_WT.translation().x() += line % 2 == 1 ? 5e-3 : 0;
    step.feed = 10e-3;
    step.filament = 0.1e-3;
    step.line = line;
    program.steps.push_back(step);
  }
  control::PrintOptions options;
  options.gap_control = control::GapControl::off;
  const auto result = control::print(program, rig.machine, *rig.port, options);
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.fault, Fault::power);
  EXPECT_EQ(result.stop.status, Status::faulted);
  EXPECT_EQ(result.stop.why, "the machine reports a fault: power cut");
  EXPECT_LT(result.duration, 1.5);  // 0.5 s, and the half second that shows where the tool goes
  EXPECT_EQ(rig.port->urgent(machine::UrgentCommand::clear_fault), Status::faulted);
  EXPECT_EQ(rig.port->state().fault, Fault::power);
}

}  // namespace
}  // namespace understudy::sim

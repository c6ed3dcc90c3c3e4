// The twin's side of a control cycle neither allocates nor locks nor reads or writes files, on all machines
// and plants, with faults on. Observers are off: they are not part of a cycle.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/as_built/as_built.h"
#include "sim/twin/simulated_port.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using machine::Setpoint;
using machine::Status;

struct Case {
  const char* machine;
  const char* engine;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.machine << " in " << c.engine; }

std::unique_ptr<Plant> make_plant(const std::string& engine, const machine::MachineDescription& machine,
                                  const AsBuilt& built) {
  if (engine == "mujoco") return make_mujoco_plant(machine, built);
  if (engine == "bullet") return make_bullet_plant(machine, built);
  return make_quasistatic_plant(machine, built);
}

/// One of every kind, all of them within the half second that is watched, and a growth beyond it.
std::vector<FaultEvent> every_fault() {
  return {{FaultKind::thermal_growth, 1, 0.05, 0, 2.0, 30e-6},
          {FaultKind::lost_steps, 0, 0.25, 4},
          {FaultKind::stall, 2, 0.30, 0, 0.03},
          {FaultKind::loose_joint, 3, 0.35, 0, 0, 20e-6},
          {FaultKind::disconnected, 4, 0.40}};
}

class PortCycle : public testing::TestWithParam<Case> {
 protected:
  PortCycle() : machine_(machine::load_machine(GetParam().machine)) {
    // A released drive that is not self-locking is more than the quasistatic plant can play.
    for (machine::Drive& drive : machine_.drives) drive.self_locking = true;
    built_ = make_as_built(machine_, "sampled", 3);
    plant_ = make_plant(GetParam().engine, machine_, built_);
  }

  /// Every axis swings about home, a setpoint a millisecond.
  std::vector<Setpoint> swing(const AxisVector& home, double from, double until) const {
    std::vector<Setpoint> setpoints;
    const double rate = 2 * std::numbers::pi / 0.5, amplitude = 0.5e-3;  // [rad/s], [m] or [rad]
    for (double t = from + 1e-3; t < until; t += 1e-3) {
      Setpoint s;
      s.time = t;
      s.position = home;
      for (std::size_t i = 0; i < 6; ++i) {
        s.position[i] += amplitude * (1 - std::cos(rate * t));
        s.velocity[i] = amplitude * rate * std::sin(rate * t);
      }
      setpoints.push_back(s);
    }
    return setpoints;
  }

  void expect_quiet(const std::vector<FaultEvent>& faults) {
    TwinOptions options;
    options.faults = faults;
    SimulatedPort port(machine_, *plant_, {}, {}, options);
    const std::vector<Setpoint> setpoints = swing(port.state().position, 0, 0.75);
    const std::span<const Setpoint> all(setpoints);
    ASSERT_EQ(port.submit(all.first(300), 1), Status::ok);
    ASSERT_EQ(port.wait_until(0.2), Status::ok);
    Status submitted = Status::faulted, waited = Status::faulted;
    Status held = Status::faulted, resumed = Status::faulted, switched = Status::faulted;
    double seen = 0;
    const Calls made = calls_of([&] {
      submitted = port.submit(all.subspan(300, 400), 1);
      for (int cycle = 1; cycle <= 480; ++cycle) {
        waited = port.wait_until(0.2 + 1e-3 * cycle);
        const machine::AxisState state = port.state();
        seen += state.position[0] + port.now();
        if (cycle == 100) held = port.urgent(machine::UrgentCommand::hold);
        if (cycle == 230) resumed = port.urgent(machine::UrgentCommand::resume);
        switched = port.set_outputs({500, 0.5}, 2);
      }
    });
    EXPECT_EQ(made, Calls{});
    EXPECT_EQ(submitted, Status::ok);
    EXPECT_EQ(waited, Status::ok) << port.engine_failure();
    EXPECT_EQ(held, Status::ok);
    EXPECT_EQ(resumed, Status::ok);
    EXPECT_EQ(switched, Status::ok);
    EXPECT_TRUE(std::isfinite(seen));
  }

  machine::MachineDescription machine_;
  AsBuilt built_;
  std::unique_ptr<Plant> plant_;
};

TEST_P(PortCycle, NeitherAllocatesNorLocksNorTouchesFiles) { expect_quiet({}); }

TEST_P(PortCycle, StaysQuietWhileThingsGoWrong) {
  auto faults = every_fault();
  const int axes = machine_.make_mechanism()->axis_count();
  std::erase_if(faults, [&](const FaultEvent& event) { return event.axis >= axes; });
  expect_quiet(faults);
}

// Bullet allocates inside its solver at every step (btMultiBodyDynamicsWorld rebuilds its islands): it is an
// engine to compare with, not one that a machine's cycle waits for.
INSTANTIATE_TEST_SUITE_P(Machines, PortCycle,
                         testing::Values(Case{"hexapod", "mujoco"}, Case{"arm", "mujoco"},
                                         Case{"five-axis", "mujoco"}, Case{"finishing", "mujoco"},
                                         Case{"hexapod", "quasistatic"}, Case{"arm", "quasistatic"},
                                         Case{"five-axis", "quasistatic"}, Case{"finishing", "quasistatic"}),
                         [](const auto& one) {
                           std::string name = std::string(one.param.machine) + "_" + one.param.engine;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace understudy::sim

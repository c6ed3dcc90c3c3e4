#include "sim/twin/simulated_port.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/as_built/as_built.h"
#include "tests/machine/port_conformance.h"
#include "tests/machine/port_properties.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using machine::Fault;
using machine::Setpoint;
using machine::Status;

/// A plant without mechanics: axes are where the drives say. It remembers what it was told.
class RigidPlant : public Plant {
 public:
  std::string engine() const override { return "rigid 1"; }
  double timestep() const override { return 0.5e-3; }
  double time() const override { return time_; }
  void reset(const AxisVector& displacement) override { displacement_ = displacement; }
  void step(const DriveCommand& command) override {
    if (time_ > diverge_at) throw MachineError("diverged");
    displacement_ = command.position;
    time_ += timestep();
    commands.push_back(command);
  }
  void set_condition(int axis, const AxisCondition& condition) override {
    conditions.emplace_back(axis, condition);
  }
  Pose tool_pose() const override { return Pose(Eigen::Translation3d(time_, displacement_[0], 0)); }
  AxisVector displacement() const override { return displacement_; }
  AxisVector drive_force() const override { return {}; }
  double closure_error() const override { return 0; }

  std::vector<DriveCommand> commands;
  std::vector<std::pair<int, AxisCondition>> conditions;
  double diverge_at = std::numeric_limits<double>::infinity();

 private:
  double time_ = 0;
  AxisVector displacement_{};
};

/// The hexapod on a plant that obeys.
class TwinOnTrial : public machine::PortOnTrial {
 public:
  TwinOnTrial()
      : machine_(machine::load_machine("hexapod")),
        port_(machine_, plant_,
              [this](const Shot& shot) {
                if (lost_) return Image{};
                const auto pixels = static_cast<std::size_t>(shot.region.width * shot.region.height);
                return Image{shot.region, std::vector<std::uint8_t>(pixels)};
              },
              {}) {
    range = machine_.make_mechanism()->axis_range(0);
    capacity = TwinOptions().queue_capacity;
    clock_step = plant_.timestep();
    resolution = 0.5 * machine_.drives[0].step();
  }
  machine::MachinePort& port() override { return port_; }
  void lose_frames(bool lost) override { lost_ = lost; }

 private:
  machine::MachineDescription machine_;
  RigidPlant plant_;
  bool lost_ = false;
  SimulatedPort port_;
};

class SimulatedPortTest : public ::testing::Test {
 protected:
  SimulatedPortTest() : machine_(machine::load_machine("hexapod")), port_(machine_, plant_, exposure(), {}) {
    home_ = port_.state().position;
  }

  Exposure exposure() {
    return [this](const Shot& shot) {
      exposed_at_ = shot.X_WT.translation().x();
      const auto pixels = static_cast<std::size_t>(shot.region.width * shot.region.height);
      return Image{shot.region, std::vector<std::uint8_t>(pixels, 7)};
    };
  }

  /// Strut 1 at `speed` [m/s], one setpoint a millisecond, starting now.
  std::vector<Setpoint> ramp(double speed, int count, bool rest_at_end) const {
    std::vector<Setpoint> setpoints;
    for (int i = 1; i <= count; ++i) {
      Setpoint s;
      s.time = port_.now() + 1e-3 * i;
      s.position = home_;
      s.position[0] += speed * 1e-3 * i;
      s.velocity[0] = rest_at_end && i == count ? 0 : speed;
      s.filament = 1e-4 * i;
      s.line = 10 + i;
      setpoints.push_back(s);
    }
    return setpoints;
  }

  machine::MachineDescription machine_;
  RigidPlant plant_;
  SimulatedPort port_;
  AxisVector home_{};
  double exposed_at_ = -1;
};

TEST_F(SimulatedPortTest, StartsAtRestAtHome) {
  kinematics::StrutLengths lengths{};
  ASSERT_EQ(kinematics::inverse(machine_.hexapod().geometry, machine_.X_BT_home, lengths),
            kinematics::SolveStatus::ok);
  for (std::size_t i = 0; i < lengths.size(); ++i) EXPECT_NEAR(home_[i], lengths[i], 1e-12);
  EXPECT_FALSE(port_.state().moving);
}

TEST_F(SimulatedPortTest, DrivesMoveInWholeMicrosteps) {
  ASSERT_EQ(port_.submit(ramp(0.003, 200, true), 1), Status::ok);
  ASSERT_EQ(port_.wait_until(0.25), Status::ok);
  const double step = machine_.drives[0].step();
  for (const auto& command : plant_.commands) {
    const double steps = command.position[0] / step;
    ASSERT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST_F(SimulatedPortTest, AnAxisAskedForTooMuchStaysAtItsLimitOnlyWhereThatIsAskedFor) {
  const double upper = machine_.make_mechanism()->axis_range(0).upper;
  const int beyond = static_cast<int>((upper - home_[0]) / 5e-6) + 1000;  // 5 mm past the end
  EXPECT_EQ(port_.submit(ramp(0.005, beyond, true), 1), Status::rejected);

  RigidPlant plant;
  TwinOptions options;
  options.hold_at_limits = true;
  options.queue_capacity = static_cast<std::size_t>(beyond);
  SimulatedPort held(machine_, plant, {}, {}, options);
  ASSERT_EQ(held.submit(ramp(0.005, beyond, true), 1), Status::ok);
  ASSERT_EQ(held.wait_until(1e-3 * beyond + 0.01), Status::ok);
  const double step = machine_.drives[0].step();
  EXPECT_NEAR(held.state().position[0], upper, step);
  for (const auto& command : plant.commands)
    ASSERT_LE(command.position[0] + machine_.drive_zero()[0], upper + step);
}

TEST_F(SimulatedPortTest, StopDeceleratesWithoutAJolt) {
  ASSERT_EQ(port_.submit(ramp(0.02, 1000, true), 2), Status::ok);
  ASSERT_EQ(port_.wait_until(0.1), Status::ok);
  ASSERT_EQ(port_.urgent(machine::UrgentCommand::stop), Status::ok);
  ASSERT_EQ(port_.wait_until(0.5), Status::ok);
  // 0.1 s at 20 mm/s and a linear ramp of 0.1 s: 2 mm + 1 mm.
  EXPECT_NEAR(port_.state().position[0] - home_[0], 3e-3, 0.05e-3);
  EXPECT_EQ(port_.state().free_slots, 4096u);
  // Once at speed, no step is longer than at full speed; the first setpoint starts from rest and overshoots.
  for (std::size_t i = 10; i < plant_.commands.size(); ++i) {
    const double step = plant_.commands[i].position[0] - plant_.commands[i - 1].position[0];
    ASSERT_LE(step, 0.02 * 0.5e-3 + machine_.drives[0].step());
    ASSERT_GE(step, -1e-12);
  }
}

TEST_F(SimulatedPortTest, AFrameTakesTheMicroscopesTime) {
  machine::Frame frame;
  const Region region{10, 20, 30, 40};
  EXPECT_EQ(port_.capture(region, frame, 1e-3), Status::deadline_exceeded);
  EXPECT_EQ(port_.now(), 0);
  ASSERT_EQ(port_.capture(region, frame, 1), Status::ok);
  const auto& m = machine_.microscope;
  EXPECT_NEAR(exposed_at_, 0.5 * m.exposure, plant_.timestep());
  EXPECT_NEAR(frame.exposed_at, exposed_at_, 1e-12);
  EXPECT_NEAR(frame.received_at, m.exposure + m.transfer, plant_.timestep());
  EXPECT_EQ(frame.image.region, region);
  const auto first = frame.number;
  ASSERT_EQ(port_.capture(region, frame, 1), Status::ok);
  EXPECT_GT(frame.number, first);
}

TEST_F(SimulatedPortTest, AnEngineThatDivergesIsAFaultThatStays) {
  plant_.diverge_at = 0.05;
  EXPECT_EQ(port_.wait_until(0.2), Status::faulted);
  EXPECT_EQ(port_.state().fault, Fault::engine);
  EXPECT_EQ(port_.engine_failure(), "diverged");
  EXPECT_EQ(port_.urgent(machine::UrgentCommand::clear_fault), Status::faulted);
}

class Recorder : public Observer {
 public:
  void observe(const Snapshot& s) override { snapshots.push_back(s); }
  std::vector<Snapshot> snapshots;
};

TEST_F(SimulatedPortTest, AfterAFaultTheHeaterCanOnlyBeSwitchedOff) {
  Recorder recorder;
  SimulatedPort port(machine_, plant_, {}, {&recorder});
  ASSERT_EQ(port.set_outputs({483, 0.5}, 1), Status::ok);
  ASSERT_EQ(port.submit(ramp(0.01, 50, false), 1), Status::ok);
  ASSERT_EQ(port.wait_until(0.2), Status::faulted);
  EXPECT_EQ(port.set_outputs({483, 0}, 1), Status::faulted);
  EXPECT_EQ(recorder.snapshots.back().nozzle_temperature, 483);
  EXPECT_EQ(port.set_outputs({}, 1), Status::ok);
  ASSERT_EQ(port.urgent(machine::UrgentCommand::clear_fault), Status::ok);
  ASSERT_EQ(port.wait_until(port.now() + 0.1), Status::ok);
  EXPECT_EQ(recorder.snapshots.back().nozzle_temperature, 0);
}

TEST(SimulatedPort, SwitchingAnObserverOffLeavesTheTrajectoryBitIdentical) {
  const auto machine = machine::load_machine("hexapod");
  Pose end[2];
  for (const bool watched : {false, true}) {
    const auto plant = make_mujoco_plant(machine, make_as_built(machine, "sampled", 3));
    Recorder recorder;
    std::vector<Observer*> observers;
    if (watched) observers.push_back(&recorder);
    SimulatedPort port(machine, *plant, {}, observers);
    std::vector<Setpoint> setpoints;
    const AxisVector start = port.state().position;
    for (int i = 1; i <= 300; ++i) {
      Setpoint s;
      s.time = port.now() + 1e-3 * i;
      s.position = start;
      for (std::size_t k = 0; k < 6; ++k) s.position[k] += 1e-3 * (1 - std::cos(0.02 * i)) * (k % 2 ? 1 : -1);
      for (std::size_t k = 0; k < 6; ++k)
        s.velocity[k] = i == 300 ? 0 : 20e-3 * std::sin(0.02 * i) * (k % 2 ? 1 : -1);
      setpoints.push_back(s);
    }
    ASSERT_EQ(port.submit(setpoints, 10), Status::ok);
    ASSERT_EQ(port.wait_until(port.now() + 0.4), Status::ok);
    end[watched] = plant->tool_pose();
    if (watched) {
      EXPECT_NEAR(static_cast<double>(recorder.snapshots.size()), 200, 2);  // 0.4 s, one each 2 ms
      EXPECT_GT((recorder.snapshots.back().X_WT.translation() -
                 recorder.snapshots.back().X_WT_commanded.translation())
                    .norm(),
                1e-6);  // as built is not nominal
    }
  }
  EXPECT_TRUE((end[0].matrix().array() == end[1].matrix().array()).all());
}

}  // namespace
}  // namespace understudy::sim

namespace understudy::machine {
INSTANTIATE_TEST_SUITE_P(Twin, PortConformance, testing::Values(+[]() -> std::unique_ptr<PortOnTrial> {
                           return std::make_unique<sim::TwinOnTrial>();
                         }));

TEST(SimulatedPortProperties, RandomOperationsGoAsTheModelSays) {
  expect_port_obeys_the_model(
      +[]() -> std::unique_ptr<PortOnTrial> { return std::make_unique<sim::TwinOnTrial>(); }, {30, 30});
}
}  // namespace understudy::machine

#include "drivers/hal/hal_port.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/drivers/hal/hal_machine.h"
#include "tests/drivers/hal/received_setpoints.h"
#include "tests/machine/port_conformance.h"

namespace understudy::drivers {
namespace {

using machine::AxisState;
using machine::Fault;
using machine::Setpoint;
using machine::Status;
using machine::UrgentCommand;

constexpr double kNever = 1e9;
constexpr int kHoldRuns = 20;

class HalOnTrial : public machine::PortOnTrial {
 public:
  HalOnTrial() {
    HalPortOptions options;
    options.folder = hal_.folder();
    options.lead = HalMachine::kLead;
    options.frames = [this](const AxisState&, const Region& region, Image& image) {
      image.region = region;
      image.pixels.assign(static_cast<std::size_t>(region.width * region.height), 7);
      return !lost_;
    };
    port_ = std::make_unique<HalPort>(hal_.machine(), options);
    range = hal_.machine().make_mechanism()->axis_range(0);
    capacity = 4096;
    clock_step = hal_.machine().cycle_time;
    resolution = 2 * hal_.step();
    drift = 0.1;  // a loaded computer without a real-time kernel
  }
  machine::MachinePort& port() override { return *port_; }
  void lose_frames(bool lost) override { lost_ = lost; }

 private:
  HalMachine hal_;
  std::unique_ptr<HalPort> port_;
  bool lost_ = false;
};

class HalPortTest : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_HAL(); }
};

TEST_F(HalPortTest, MovesAndReadsBackWithinAStep) {
  const HalMachine hal;
  const auto port = hal.open();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  const AxisState start = port->state();
  Setpoint s;
  s.time = port->now() + 0.5;
  s.position = start.position;
  for (std::size_t i = 0; i < 6; ++i) s.position[i] += 1e-3 * static_cast<double>(i + 1);
  ASSERT_EQ(port->submit(std::array{s}, kNever), Status::ok);
  ASSERT_EQ(port->wait_until(s.time + 0.01), Status::ok) << port->fault_text();
  const AxisState end = port->state();
  EXPECT_EQ(end.executed, 1U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(end.position[i], s.position[i], hal.step()) << i;
  EXPECT_EQ(port->counts().underruns, 0U);
}

TEST_F(HalPortTest, ReadsTheEncodersBehindThePlayBesideTheDrives) {
  const HalMachine hal(HalMachine::trial_options(), "\nload_encoders:\n  count_um: 0.5\n");
  const RunningHal running(hal);
  // The scale along strut 3 reads 12.5 um more than the drive: a zero that is off.
  RunningHal::command({"setp", "encoder-of-l3.offset", "0.0125"});
  const auto port = hal.attach();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  Setpoint s;
  s.time = port->now() + 0.5;
  s.position = port->state().position;
  for (std::size_t i = 0; i < 6; ++i) s.position[i] += 1e-3 * static_cast<double>(i + 1);
  ASSERT_EQ(port->submit(std::array{s}, kNever), Status::ok);
  ASSERT_EQ(port->wait_until(s.time + 0.01), Status::ok) << port->fault_text();
  const AxisState end = port->state();
  machine::LoadReading load;
  ASSERT_TRUE(machine::read_load(*port, load));
  EXPECT_EQ(load.sampled_at, end.sampled_at);
  // Samples have six decimals of a mm.
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(load.position[i] - end.position[i], i == 2 ? 12.5e-6 : 0, 1.1e-9) << i;
}

TEST_F(HalPortTest, AMachineWithoutEncodersBehindThePlayHasNoReading) {
  const HalMachine hal;
  const auto port = hal.open();
  machine::LoadReading load;
  load.position[0] = 7;
  EXPECT_FALSE(machine::read_load(*port, load));
  EXPECT_EQ(load.position[0], 7);
}

/// A period's setpoints of axis 0 from where the clock stands, out by `depth` and back, at rest at both ends.
std::vector<Setpoint> there_and_back(const machine::MachinePort& port, const machine::AxisVector& start,
                                     double depth, double seconds) {
  std::vector<Setpoint> setpoints;
  const auto count = static_cast<int>(std::lround(seconds / 1e-3));
  for (int i = 1; i <= count; ++i) {
    const double phase = 2 * std::numbers::pi * i / count;
    Setpoint s;
    s.time = port.now() + i * 1e-3;
    s.position = start;
    for (std::size_t axis = 0; axis < 6; ++axis) {
      s.position[axis] += depth * (1 - std::cos(phase)) / 2;
      s.velocity[axis] = depth * std::sin(phase) / 2 * 2 * std::numbers::pi / seconds;
    }
    if (i == count) s.velocity = {};
    setpoints.push_back(s);
  }
  return setpoints;
}

class ExtendedHalPortTest : public HalPortTest {};

TEST_F(ExtendedHalPortTest, HoldsResumesAndAStopLoseAndRepeatNoSetpoint) {
  const HalMachine hal;
  const auto port = hal.open();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  HalRecorder received(hal, 1);
  RememberingPort remembering(*port);
  std::mt19937 random(7);
  const auto pick = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int holds = 0;
  for (int run = 0; run < kHoldRuns; ++run) {
    const bool stops = run == kHoldRuns / 2;
    const auto start = port->state().position;
    ASSERT_EQ(remembering.submit(there_and_back(*port, start, 2e-3, 0.25), kNever), Status::ok);
    for (int k = 0; k < 2; ++k) {
      ASSERT_EQ(remembering.wait_until(port->now() + pick(0.01, 0.1)), Status::ok) << port->fault_text();
      if (stops && k == 1) {
        ASSERT_EQ(remembering.urgent(UrgentCommand::stop), Status::ok);
        break;
      }
      ASSERT_EQ(remembering.urgent(UrgentCommand::hold), Status::ok);
      ++holds;
      // Sometimes before it has come to rest.
      ASSERT_EQ(remembering.wait_until(port->now() + pick(0.02, 0.15)), Status::ok) << port->fault_text();
      ASSERT_EQ(remembering.urgent(UrgentCommand::resume), Status::ok);
    }
    int patience = 100;
    do ASSERT_EQ(remembering.wait_until(port->now() + 0.05), Status::ok) << port->fault_text();
    while (port->state().moving && --patience > 0);
    ASSERT_GT(patience, 0) << "run " << run;
    // At rest with an empty queue: what is submitted next is not late by what the holds have cost.
    ASSERT_EQ(remembering.urgent(UrgentCommand::stop), Status::ok);
  }
  const auto rows = remembering.rows(hal.settings().cycle);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(expect_received(received.samples(), rows, hal.settings()), rows.size());
  std::printf("%d runs, %d holds, one stop: %zu setpoint rows, none lost, none repeated\n", kHoldRuns, holds,
              rows.size());
}

TEST_F(HalPortTest, AControllerThatIsLaterThanTheLeadGetsAStickyUnderrunAndMayGoOn) {
  const HalMachine hal;
  const auto port = hal.open(0.3);
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  HalRecorder done(hal, 3);
  const auto start = port->state().position;
  ASSERT_EQ(port->submit(there_and_back(*port, start, 10e-3, 1), kNever), Status::ok);
  ASSERT_EQ(port->wait_until(port->now() + 0.3), Status::ok) << port->fault_text();
  // What is under way ends at most 0.3 s later.
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  EXPECT_EQ(port->wait_until(port->now() + 1), Status::faulted);
  EXPECT_EQ(port->state().fault, Fault::underrun);
  EXPECT_GT(port->counts().underruns, 0U);
  EXPECT_THAT(port->fault_text(), testing::HasSubstr("later than the lead"));
  const auto rest = port->state().position;
  ASSERT_EQ(port->urgent(UrgentCommand::clear_fault), Status::ok) << port->fault_text();
  ASSERT_EQ(port->submit(there_and_back(*port, port->state().position, -1e-3, 0.3), kNever), Status::ok);
  ASSERT_EQ(port->wait_until(port->now() + 0.4), Status::ok) << port->fault_text();
  EXPECT_NEAR(port->state().position[0], rest[0], 2 * hal.step());
  // It braked beyond the last setpoint and came back to it.
  double farthest = 0;
  for (const auto& sample : done.samples()) farthest = std::max(farthest, sample[0]);
  const double beyond = farthest - hal.settings().axes[0].units(rest[0]);
  std::printf("underrun at 30 mm/s: %.3f mm beyond the last setpoint, then back to it\n", beyond);
  // v^2 / 2a of its 2.2 m/s2, and the periods until HAL sees that no row comes.
  EXPECT_GT(beyond, 0.0);
  EXPECT_LT(beyond, 31.5 * 31.5 / (2 * 2200) + 31.5 * 3e-3);
}

/// Within 5 s: rows under way and braking come first.
bool becomes(const char* signal, const std::string& value) {
  for (int k = 0; k < 100; ++k) {
    if (RunningHal::command({"gets", signal}) == value) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST_F(ExtendedHalPortTest, FaultsOfTheMachineAreNamedStickyAndCleared) {
  const HalMachine hal;
  const RunningHal running(hal);
  const auto port = hal.attach();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  const struct {
    const char* signal;
    const char* struck;
    const char* released;
    Fault fault;
    const char* text;
  } cases[] = {
      {"emergency-stop-ok", "0", "1", Fault::emergency_stop, "chain of emergency stops is open"},
      {"l3-limit-switch", "1", "0", Fault::limit_switch, "limit switch"},
      {"software-stop", "1", "0", Fault::drive, "switched the machine off"},
  };
  for (const auto& c : cases) {
    const auto start = port->state().position;
    ASSERT_EQ(port->submit(there_and_back(*port, start, 5e-3, 2), kNever), Status::ok);
    ASSERT_EQ(port->set_outputs({483, 0.5}, port->now() + 1), Status::ok);
    ASSERT_EQ(port->wait_until(port->now() + 0.3), Status::ok) << c.signal;
    RunningHal::command({"sets", c.signal, c.struck});
    EXPECT_EQ(port->wait_until(port->now() + 5), Status::faulted) << c.signal;
    EXPECT_EQ(port->state().fault, c.fault) << c.signal;
    EXPECT_THAT(port->fault_text(), testing::HasSubstr(c.text));
    EXPECT_TRUE(becomes("drives-on", "FALSE\n")) << "it has braked and is off";
    EXPECT_EQ(RunningHal::command({"gets", "nozzle-setpoint"}), "0\n");
    EXPECT_EQ(port->urgent(UrgentCommand::clear_fault), Status::faulted) << c.signal << " still stands";
    RunningHal::command({"sets", c.signal, c.released});
    ASSERT_EQ(port->urgent(UrgentCommand::clear_fault), Status::ok) << port->fault_text();
    EXPECT_EQ(port->state().fault, Fault::none);
    ASSERT_EQ(port->submit(there_and_back(*port, port->state().position, 1e-3, 0.2), kNever), Status::ok);
    ASSERT_EQ(port->wait_until(port->now() + 0.25), Status::ok) << port->fault_text();
  }
}

TEST_F(HalPortTest, ADriveThatCannotFollowStopsTheMachine) {
  HalOptions tight = HalMachine::trial_options();
  tight.following = 0.005;
  const HalMachine hal(tight);
  const RunningHal running(hal);
  RunningHal::command({"setp", "stepgen.2.maxvel", "0.5"});
  const auto port = hal.attach();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  ASSERT_EQ(port->submit(there_and_back(*port, port->state().position, 5e-3, 1), kNever), Status::ok);
  EXPECT_EQ(port->wait_until(port->now() + 2), Status::faulted);
  EXPECT_EQ(port->state().fault, Fault::following_error) << port->fault_text();
}

TEST_F(HalPortTest, HalThatEndsIsAFaultThatStays) {
  const HalMachine hal;
  auto running = std::make_unique<RunningHal>(hal);
  const auto port = hal.attach();
  ASSERT_EQ(port->state().fault, Fault::none) << port->fault_text();
  running.reset();
  EXPECT_EQ(port->wait_until(port->now() + 60), Status::faulted);
  EXPECT_EQ(port->state().fault, Fault::drive);
  EXPECT_EQ(port->urgent(UrgentCommand::clear_fault), Status::faulted);
}

TEST_F(HalPortTest, AnEmergencyStopDoesNotWaitForTheQueue) {
  const HalMachine hal;
  const auto port = hal.open();
  ASSERT_EQ(port->submit(there_and_back(*port, port->state().position, 5e-3, 2), kNever), Status::ok);
  ASSERT_EQ(port->wait_until(port->now() + 0.3), Status::ok);
  port->emergency_stop();
  EXPECT_EQ(port->wait_until(port->now() + 1), Status::faulted);
  EXPECT_EQ(port->state().fault, Fault::emergency_stop);
  EXPECT_EQ(port->urgent(UrgentCommand::clear_fault), Status::faulted);
}

TEST(HalPortOptions, ComeFromAUriOrAreRefused) {
  EXPECT_EQ(hal_port_options("hal://").folder, "");
  EXPECT_EQ(hal_port_options("hal://hexapod-hal").folder, "hexapod-hal");
  EXPECT_EQ(hal_port_options("hal:///etc/hexapod").folder, "/etc/hexapod");
  EXPECT_DOUBLE_EQ(hal_port_options("hal://x?lead_ms=350").lead, 0.35);
  const auto refusal = [](const char* uri) {
    try {
      hal_port_options(uri);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal("hal:/x"), testing::HasSubstr("not hal://FOLDER"));
  EXPECT_THAT(refusal("hal://x?lag=3"), testing::HasSubstr("unknown option 'lag': lead_ms"));
  EXPECT_THAT(refusal("hal://x?lead_ms=5"), testing::HasSubstr("'5', not a number from 20 to 3000"));
  EXPECT_THAT(refusal("hal://x?lead_ms=soon"), testing::HasSubstr("'soon'"));
}

}  // namespace
}  // namespace understudy::drivers

namespace understudy::machine {

// A second and more each, of real time.
INSTANTIATE_TEST_SUITE_P(SlowHal, PortConformance, testing::Values(+[]() -> std::unique_ptr<PortOnTrial> {
                           return std::make_unique<drivers::HalOnTrial>();
                         }));

}  // namespace understudy::machine

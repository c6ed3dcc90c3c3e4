#include "drivers/gcode/gcode_port.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/drivers/gcode/gcode_trial.h"
#include "tests/drivers/gcode/moving_rsh.h"
#include "tests/machine/port_conformance.h"

namespace understudy::machine {
namespace {

/// Marlin and RepRapFirmware say where they stand at rests only, so their axes seem late by the motion
/// itself.
template <drivers::Firmware firmware>
class GcodeOnTrial : public PortOnTrial {
 public:
  GcodeOnTrial() : trial_(drivers::make_trial(firmware)) {
    range = drivers::trial_machine().make_mechanism()->axis_range(0);
    capacity = 4096;
    clock_step = 0;
    // 0.5 um of the report, 5 um of Marlin's, and half a block's grid.
    resolution = firmware == drivers::Firmware::marlin ? 5.1e-6 : 0.6e-6;
    latency = firmware == drivers::Firmware::grblhal ? 0.6 : 1.6;
    camera = false;
  }
  MachinePort& port() override { return *trial_.port; }
  void lose_frames(bool /*lost*/) override {}

 private:
  drivers::GcodeTrial trial_;
};

/// LinuxCNC, by linuxcncrsh: in poses.
class LinuxcncOnTrial : public PortOnTrial {
 public:
  LinuxcncOnTrial() {
    const auto& machine = drivers::MovingRsh::described();
    const auto setup =
        drivers::gcode_setup(drivers::parse_port_uri("tcp://none:5007?family=linuxcnc"), machine);
    port_ = std::make_unique<drivers::GcodePort>(std::make_unique<drivers::MovingRsh>(), setup, machine);
    range = machine.make_mechanism()->axis_range(0);
    capacity = 4096;
    clock_step = 0;
    resolution = 0.2e-6;  // 0.1 um and 0.01 mdeg of a word, half of it in each of six
    latency = 1.6;        // the lookahead, a block, ten lines a second, and a rest that is waited for
    camera = false;
  }
  MachinePort& port() override { return *port_; }
  void lose_frames(bool /*lost*/) override {}

 private:
  std::unique_ptr<drivers::GcodePort> port_;
};

template <drivers::Firmware firmware>
std::unique_ptr<PortOnTrial> make() {
  return std::make_unique<GcodeOnTrial<firmware>>();
}

INSTANTIATE_TEST_SUITE_P(Grblhal, PortConformance, testing::Values(&make<drivers::Firmware::grblhal>));
INSTANTIATE_TEST_SUITE_P(Marlin, PortConformance, testing::Values(&make<drivers::Firmware::marlin>));
INSTANTIATE_TEST_SUITE_P(Reprapfirmware, PortConformance,
                         testing::Values(&make<drivers::Firmware::reprapfirmware>));
INSTANTIATE_TEST_SUITE_P(Linuxcnc, PortConformance, testing::Values(+[]() -> std::unique_ptr<PortOnTrial> {
                           return std::make_unique<LinuxcncOnTrial>();
                         }));

}  // namespace
}  // namespace understudy::machine

namespace understudy::drivers {
namespace {

using machine::Setpoint;
using machine::Status;

constexpr double kNever = 1e9;

/// Axis i swings by some millimetres, from rest to rest, with filament.
std::vector<Setpoint> swing(const machine::MachinePort& port, double seconds, double phase = 0) {
  std::vector<Setpoint> setpoints;
  const machine::AxisState begin = port.state();
  const auto count = static_cast<int>(std::lround(seconds * 1e3));
  for (int n = 1; n <= count; ++n) {
    const double t = n * 1e-3, share = t / seconds;
    const double s = share * share * (3 - 2 * share), ds = 6 * share * (1 - share) / seconds;
    Setpoint p;
    p.time = begin.time + t;
    p.line = 1 + n / 100;
    p.filament = 0.02 * s;
    for (std::size_t i = 0; i < 6; ++i) {
      const double w = 2 + 0.3 * static_cast<double>(i) + phase;
      p.position[i] = begin.position[i] + 2e-3 * std::sin(w * s);
      p.velocity[i] = 2e-3 * w * std::cos(w * s) * ds;
    }
    if (n == count) p.velocity = {};
    setpoints.push_back(p);
  }
  return setpoints;
}

class EveryFamily : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Families, EveryFamily,
                         testing::Values(Firmware::grblhal, Firmware::marlin, Firmware::reprapfirmware));

/// Of what the controller ran, at a time that counts from where its motion began. [mm]
std::array<double, 8> position_in(const std::vector<ScriptedController::Ran>& ran, double time, double* fed) {
  for (const auto& block : ran) {
    if (time > block.end) continue;
    const double share = std::clamp((time - block.begin) / (block.end - block.begin), 0.0, 1.0);
    std::array<double, 8> at{};
    for (std::size_t i = 0; i < 8; ++i) at[i] = block.from[i] + share * (block.to[i] - block.from[i]);
    *fed = block.fed_from + share * (block.fed_to - block.fed_from);
    return at;
  }
  *fed = ran.back().fed_to;
  return ran.back().to;
}

TEST_P(EveryFamily, RunsThePathInPositionAndTime) {
  GcodeTrial trial = make_trial(GetParam());
  const auto setpoints = swing(*trial.port, 3);
  ASSERT_EQ(trial.port->submit(setpoints, kNever), Status::ok);
  ASSERT_EQ(trial.port->wait_until(4), Status::ok) << trial.port->fault_text();
  EXPECT_EQ(trial.port->state().executed, setpoints.size());
  EXPECT_FALSE(trial.port->state().moving);
  const auto& ran = trial.controller->ran();
  ASSERT_FALSE(ran.empty());
  for (std::size_t n = 1; n < ran.size(); ++n)
    ASSERT_NEAR(ran[n].begin, ran[n - 1].end, 1e-12) << "the controller had nothing to do: " << ran[n].words;
  // The setpoint within 2 um of where the controller is within 1 ms, and 1 um for setpoints 1 ms apart that
  // themselves are cut at 14 mm/s.
  for (const Setpoint& s : setpoints) {
    double best = 1e9;
    for (double late = -1e-3; late <= 1.0001e-3; late += 0.1e-3) {
      double fed = 0, square = 0;
      const auto at =
          position_in(ran, ran.front().begin + s.time - setpoints.front().time + 1e-3 + late, &fed);
      for (std::size_t i = 0; i < 6; ++i) square += std::pow(at[i] * 1e-3 - s.position[i], 2);
      best = std::min(best, std::sqrt(square));
    }
    ASSERT_LT(best, 2.1e-6) << "at " << s.time;
  }
  EXPECT_NEAR(ran.back().fed_to, 20, 1e-4);
  EXPECT_LT(ran.size(), setpoints.size() / 10) << "few blocks";
}

TEST_P(EveryFamily, ExecutedIsWhatTheControllerHasDone) {
  GcodeTrial trial = make_trial(GetParam());
  ASSERT_EQ(trial.port->submit(swing(*trial.port, 2), kNever), Status::ok);
  for (double t = 0.1; t < 3; t += 0.1) {
    ASSERT_EQ(trial.port->wait_until(t), Status::ok);
    double done = 0;
    for (const auto& block : trial.controller->ran()) done += block.end - block.begin;
    ASSERT_LE(static_cast<double>(trial.port->state().executed), 1e3 * done + 1);
  }
  EXPECT_EQ(trial.port->state().executed, 2000U);
}

TEST_P(EveryFamily, AStopLeavesNothingOnTheWay) {
  GcodeTrial trial = make_trial(GetParam());
  ASSERT_EQ(trial.port->submit(swing(*trial.port, 3), kNever), Status::ok);
  ASSERT_EQ(trial.port->wait_until(1.5), Status::ok);
  ASSERT_EQ(trial.port->urgent(machine::UrgentCommand::stop), Status::ok);
  ASSERT_EQ(trial.port->wait_until(2.5), Status::ok);
  EXPECT_FALSE(trial.port->state().moving);
  const auto ran = trial.controller->ran().size();
  ASSERT_EQ(trial.port->wait_until(3.5), Status::ok);
  EXPECT_EQ(trial.controller->ran().size(), ran);
}

TEST_P(EveryFamily, TimeStandsWhileItHeatsUp) {
  GcodeTrial trial = make_trial(GetParam());
  ASSERT_EQ(trial.port->set_outputs({473.15, 0}, kNever), Status::ok);
  ASSERT_EQ(trial.port->submit(swing(*trial.port, 0.5), kNever), Status::ok);
  ASSERT_EQ(trial.port->wait_until(2), Status::ok) << trial.port->fault_text();
  EXPECT_EQ(trial.controller->temperature(), 200);
  // The scripted heater takes two seconds.
  EXPECT_GT(trial.controller->ran().front().begin, 2);
  ASSERT_EQ(trial.port->set_outputs({}, kNever), Status::ok);
  ASSERT_EQ(trial.port->wait_until(2.5), Status::ok);
  EXPECT_EQ(trial.controller->temperature(), 0);
}

/// What the fault says, of a session in which something goes wrong in motion.
std::string fault_of(Firmware firmware, const Mischief& mischief, SimulatedLink::Setup line,
                     machine::Fault expected) {
  GcodeTrial trial = make_trial(firmware, mischief, line);
  EXPECT_EQ(trial.port->submit(swing(*trial.port, 3), kNever), Status::ok);
  EXPECT_EQ(trial.port->wait_until(20), Status::faulted);
  EXPECT_EQ(trial.port->state().fault, expected);
  EXPECT_LT(trial.port->state().executed, 3000U);
  EXPECT_EQ(trial.port->urgent(machine::UrgentCommand::clear_fault), Status::faulted);
  return trial.port->fault_text();
}

TEST_P(EveryFamily, SaysWhatWentWrong) {
  const Firmware firmware = GetParam();
  const double when = 2;  // a second or so into the motion, after the greeting
  Mischief reset, silent, alarm, error;
  reset.reset_at = silent.silent_at = alarm.alarm_at = error.error_at = when;
  using machine::Fault;
  EXPECT_THAT(fault_of(firmware, silent, {}, Fault::power), testing::HasSubstr("has not answered for"));
  if (firmware != Firmware::reprapfirmware) {  // whose USB device goes
    EXPECT_THAT(fault_of(firmware, reset, {}, Fault::power), testing::HasSubstr("was reset"));
  }
  EXPECT_THAT(fault_of(firmware, alarm, {},
                       firmware == Firmware::grblhal ? Fault::limit_switch : Fault::emergency_stop),
              testing::AnyOf(testing::HasSubstr("ALARM:1"), testing::HasSubstr("kill")));
  EXPECT_THAT(fault_of(firmware, error, {}, Fault::drive), testing::HasSubstr("the controller says"));
  SimulatedLink::Setup pulled;
  pulled.pulled_at = when;
  EXPECT_THAT(fault_of(firmware, {}, pulled, Fault::power), testing::HasSubstr("cable"));
}

TEST(GcodePort, RefusesAnotherController) {
  // A Marlin that is taken for another, either way.
  for (const char* family : {"reprapfirmware", "grblhal"}) {
    const PortUri uri = parse_port_uri(std::string("serial:///d?boot_s=2&reply_s=1&family=") + family);
    ScriptedController::Setup peer;
    peer.firmware = Firmware::marlin;
    auto controller = std::make_shared<ScriptedController>(peer, Mischief{});
    EXPECT_THROW(GcodePort(std::make_unique<SimulatedLink>(controller, SimulatedLink::Setup{}),
                           gcode_setup(uri, trial_machine()), trial_machine()),
                 MachineError)
        << family;
  }
}

TEST(GcodePort, SaysWhichOptionIsWrong) {
  const auto refusal = [](const std::string& text) {
    try {
      (void)gcode_setup(parse_port_uri(text), trial_machine());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal("serial:///d"), HasSubstr("family=grblhal, marlin, reprapfirmware or linuxcnc"));
  EXPECT_THAT(refusal("serial:///d?family=marlyn"), HasSubstr("did you mean 'marlin'"));
  EXPECT_THAT(refusal("serial:///d?family=marlin&axes=XYZ"), HasSubstr("names 3 axes, and hexapod has 6"));
  EXPECT_THAT(refusal("serial:///d?family=marlin&axes=XYZUVV"), HasSubstr("and once"));
  EXPECT_THAT(refusal("serial:///d?family=marlin&latency_ms=1"), HasSubstr("no number from 50 to 2000"));
  EXPECT_THAT(refusal("serial:///d?family=linuxcnc"), HasSubstr("tcp://host:port"));
  EXPECT_THAT(refusal("tcp://h:5007?family=linuxcnc&axes=XYZUVW"), HasSubstr("has no such letters"));
  EXPECT_THAT(refusal("serial:///d?family=marlin&home=maybe"), HasSubstr("yes or no"));
}

}  // namespace
}  // namespace understudy::drivers

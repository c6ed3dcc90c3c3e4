// A machine whose controller dies: HAL's watchdog stops it (docs/linuxcnc.md).
#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/hal/hal_machine.h"

namespace understudy::drivers {
namespace {

constexpr double kVictimLead = 0.3;  // [s]
constexpr double kWatchdog = 0.05;   // [s]

/// Moves all axes up and down from `home` without end on the HAL that runs; never returns. The first period
/// comes from where the death before left the machine: without that it would climb from death to death until
/// its limits refuse.
[[noreturn]] void move_until_killed(const HalMachine& hal, const machine::AxisVector& home, int told) {
  const auto port = hal.attach(kVictimLead);
  const machine::AxisVector left = port->state().position;
  constexpr double kPeriod = 0.5;    // [s]
  constexpr double kDepth = 2e-3;    // [m]
  constexpr double kToSubmit = 0.1;  // [s]: on a busy computer setpoints take so long to reach the queue
  double from = port->now() + kToSubmit;
  for (bool first = true;; first = false) {
    std::vector<machine::Setpoint> setpoints;
    for (int i = 1; i <= 500; ++i) {
      const double phase = 2 * std::numbers::pi * i / 500;
      machine::Setpoint s;
      s.time = from + i * 1e-3;
      s.position = home;
      for (std::size_t axis = 0; axis < 6; ++axis) {
        // Each axis at its own phase about its place, so that never all of them rest.
        const double own = axis < 3 ? phase : 2 * phase;
        s.position[axis] += kDepth * (1 - std::cos(own)) / 2;
        s.velocity[axis] = kDepth * std::sin(own) / 2 * 2 * std::numbers::pi / kPeriod * (axis < 3 ? 1 : 2);
        if (first) {
          s.position[axis] += (left[axis] - home[axis]) * (1 + std::cos(phase / 2)) / 2;
          s.velocity[axis] -=
              (left[axis] - home[axis]) * std::sin(phase / 2) / 2 * std::numbers::pi / kPeriod;
        }
      }
      setpoints.push_back(s);
    }
    from += kPeriod;
    if (port->state().fault != machine::Fault::none) ::_exit(3);
    if (port->submit(setpoints, 1e9) != machine::Status::ok) ::_exit(first ? 6 : 7);
    if (first) {
      const char ready = 'r';
      if (::write(told, &ready, 1) != 1) ::_exit(4);
    }
    if (port->wait_until(from - 0.1) != machine::Status::ok) ::_exit(5);
  }
}

struct Stop {
  bool moved = false;    ///< steps were made after the machine was on
  bool stopped = false;  ///< off, drives off, no step any more
  int starved = 0;       ///< [periods] from the last setpoint until the machine was off
  int until_still = 0;   ///< [periods] from the last setpoint until the last step
  int depth = 0;         ///< [rows], the most that was queued
};

/// Of channel 2 from sample `begin` on: counts, depth, starved, on, drives.
Stop stop_in(const std::vector<std::vector<double>>& samples, std::size_t begin, std::size_t axes) {
  Stop stop;
  std::size_t last_row = begin, off = begin, last_step = begin;
  bool on = false;
  for (std::size_t i = begin + 1; i < samples.size(); ++i) {
    const auto& s = samples[i];
    stop.depth = std::max(stop.depth, static_cast<int>(s[axes]));
    if (s[axes + 1] == 0) last_row = i;
    if (s[axes + 2] == 1) on = true;
    if (samples[i - 1][axes + 2] == 1 && s[axes + 2] == 0) off = i;
    for (std::size_t a = 0; a < axes; ++a)
      if (s[a] != samples[i - 1][a]) last_step = i;
  }
  const auto& end = samples.back();
  stop.moved = on && last_step > begin;
  stop.stopped = on && end[axes + 2] == 0 && end[axes + 3] == 0 && last_step + 50 < samples.size();
  stop.starved = static_cast<int>(off) - static_cast<int>(last_row);
  stop.until_still = std::max(0, static_cast<int>(last_step) - static_cast<int>(last_row));
  return stop;
}

/// Until the recorder has seen the machine move, and stop if `stopped`: the lead, the watchdog, the brake,
/// and what the samplers are behind, up to ten seconds.
Stop wait_for(bool stopped, HalRecorder& recorder, std::size_t begin, std::size_t axes) {
  Stop stop;
  for (int k = 0; k < 100 && !(stop.moved && (stop.stopped || !stopped)); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto& samples = recorder.so_far();
    if (samples.size() > begin) stop = stop_in(samples, begin, axes);
  }
  return stop;
}

/// A controller in a process of its own.
struct Victim {
  pid_t pid = -1;
  bool prints = false;  ///< its first setpoints were accepted
};

Victim start_victim(const HalMachine& hal, const machine::AxisVector& home) {
  int told[2];
  if (::pipe(told) != 0) return {};
  std::fflush(nullptr);
  Victim victim{::fork()};
  if (victim.pid == 0) move_until_killed(hal, home, told[1]);
  ::close(told[1]);
  char ready = 0;
  victim.prints = victim.pid > 0 && ::read(told[0], &ready, 1) == 1;
  ::close(told[0]);
  return victim;
}

/// Whether it was alive until then.
bool kill_victim(const Victim& victim, int& status) {
  ::kill(victim.pid, SIGKILL);
  return ::waitpid(victim.pid, &status, 0) == victim.pid && WIFSIGNALED(status) &&
         WTERMSIG(status) == SIGKILL;
}

void kill_and_see(int times, unsigned seed) {
  HalOptions options = HalMachine::trial_options();
  options.watchdog = kWatchdog;
  const HalMachine hal(options);
  const RunningHal running(hal);
  HalRecorder recorder(hal, 2);
  const std::size_t axes = hal.settings().axes.size();
  machine::AxisVector home;
  for (std::size_t axis = 0; axis < 6; ++axis)
    home[axis] = hal.settings().axes[axis].si(hal.settings().axes[axis].home);
  std::mt19937 random(seed);
  int worst_starved = 0, deepest = 0, kills = 0, ended = 0;
  std::size_t begin = 0;
  while (kills < times) {
    const Victim victim = start_victim(hal, home);
    ASSERT_GE(victim.pid, 0);
    // The first setpoints may still be on their way: a machine that never began to move cannot be stopped.
    if (victim.prints) {
      wait_for(false, recorder, begin, axes);
      std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution(20, 600)(random)));
    }
    int status = 0;
    const bool was_killed = kill_victim(victim, status);
    const Stop stop = wait_for(true, recorder, begin, axes);
    begin = std::max<std::size_t>(recorder.so_far().size(), 1) - 1;
    if (!was_killed) {
      // A controller that a busy computer held up for longer than its lead has stopped the machine by itself.
      ASSERT_LE(++ended, 2 + times / 10) << "controllers ended before they were killed, the last with status "
                                         << status / 256 << " (3: fault, 6 and 7: setpoints were refused)";
      continue;
    }
    ++kills;
    EXPECT_TRUE(stop.moved) << kills;
    EXPECT_TRUE(stop.stopped) << kills;
    // In periods of HAL, whatever the computer does meanwhile: the watchdog's time, and one to see it.
    EXPECT_LE(stop.starved, kWatchdog * 1e3 + 2) << kills;
    EXPECT_LE(stop.depth, kVictimLead * 1e3) << kills << ": what moves on is no more than the lead";
    worst_starved = std::max(worst_starved, stop.starved);
    deepest = std::max(deepest, stop.depth);
  }
  std::printf(
      "%d kills: off at most %d periods after the last setpoint; at most %d setpoints were queued; "
      "%d controllers had ended before\n",
      kills, worst_starved, deepest, ended);
}

TEST(HalKill, TheWatchdogStopsTheMachineEachTimeItsControllerIsKilled) {
  SKIP_WITHOUT_HAL();
  kill_and_see(10, 1);
}

TEST(SlowHalKill, TheWatchdogStopsTheMachineAHundredTimes) {
  SKIP_WITHOUT_HAL();
  kill_and_see(100, 2);
}

TEST(HalKill, AHalThatThePortStartedIsGoneAfterItsControllerIsKilled) {
  SKIP_WITHOUT_HAL();
  const HalMachine hal;
  int told[2];
  ASSERT_EQ(::pipe(told), 0);
  const pid_t victim = ::fork();
  ASSERT_GE(victim, 0);
  if (victim == 0) {
    const auto port = hal.open(kVictimLead);
    if (port->state().fault != machine::Fault::none) ::_exit(3);
    const char ready = 'r';
    if (::write(told[1], &ready, 1) != 1) ::_exit(4);
    for (;;) ::pause();
  }
  ::close(told[1]);
  char ready = 0;
  ASSERT_EQ(::read(told[0], &ready, 1), 1);
  ::close(told[0]);
  EXPECT_THAT(RunningHal::command({"show", "sig", "machine-on"}), testing::HasSubstr("machine-on"));
  ::kill(victim, SIGKILL);
  ASSERT_EQ(::waitpid(victim, nullptr, 0), victim);
  std::string left = "machine-on";
  for (int i = 0; i < 100 && left.find("machine-on") != std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    left = RunningHal::command({"show", "sig", "machine-on"});
  }
  EXPECT_THAT(left, testing::Not(testing::HasSubstr("machine-on")));
  EXPECT_NO_THROW(static_cast<void>(hal.open(kVictimLead))) << "the next run finds nothing of it in its way";
}

}  // namespace
}  // namespace understudy::drivers

// What every MachinePort promises (docs/machine-port.md), as tests that run against any of them. Include this
// in one file of a test program and instantiate PortConformance with functions that make the ports.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "machine/port.h"

namespace understudy::machine {

/// A port that rests, and what a test must know of it. Axis 0 must be free to go 25 mm up from where it is.
class PortOnTrial {
 public:
  virtual ~PortOnTrial() = default;
  virtual MachinePort& port() = 0;
  virtual void lose_frames(bool lost) = 0;  ///< from now on the camera delivers nothing

  kinematics::AxisRange range;  ///< of axis 0
  std::size_t capacity = 0;     ///< of the queue, at least 1000
  double clock_step = 0;        ///< [s], grain of the clock
  double resolution = 0;        ///< [m], grain of axis 0
  double latency = 0;           ///< [s], at most, that the axes and what is said of them are behind the clock
  double drift = 0;             ///< [s], of a moving axis against its command: no real-time kernel
  bool camera = true;
};

using MakePort = std::unique_ptr<PortOnTrial> (*)();

class PortConformance : public testing::TestWithParam<MakePort> {
 protected:
  static constexpr double kNever = 1e9;  // [s]
  static constexpr double kCycle = 1e-3;
  static constexpr double kBraking = 0.1;  // [s], to rest, linearly
  static constexpr double kSpeed = 20e-3;  // [m/s]

  PortOnTrial& trial() { return *trial_; }
  MachinePort& port() { return trial_->port(); }
  double position() { return port().state().position[0] - start_[0]; }
  /// [s], of the position that a moving axis has: a real machine is behind the port's clock.
  double age() { return port().now() - port().state().sampled_at; }
  /// [m], where the first setpoints of travel() are at that time after its begin; at its full speed.
  static double travelled(double time) { return kSpeed * (time - 0.05); }
  /// What an axis at that speed may be off: its grain, and what it does in a grain of the clock.
  double slack(double speed = kSpeed) const {
    return 1e-12 + trial_->resolution + 2 * speed * trial_->clock_step;
  }
  double moving_slack(double speed) const { return slack(speed) + trial_->drift * speed; }

  /// Where an axis that moves upwards is between where it is to be and where it was to be a latency ago.
  void expect_on_the_way(double position_then, double position_now, double speed) {
    ASSERT_GE(position(), position_then - moving_slack(speed)) << port().now();
    ASSERT_LE(position(), position_now + moving_slack(speed)) << port().now();
  }
  /// [s], by which the axes may be behind, at least and at most: by the age of what is said of them, or by
  /// anything up to the latency of a port that does not know.
  double earlier_by() { return trial_->latency > 0 ? 0 : age(); }
  double later_by() { return trial_->latency > 0 ? trial_->latency : age(); }

  Setpoint at(double time, double position, double velocity = 0) const {
    Setpoint s;
    s.time = time;
    s.position = start_;
    s.position[0] += position;
    s.velocity[0] = velocity;
    return s;
  }
  /// Axis 0 from here on, speeding up over the first tenth of a second and at rest in the end.
  std::vector<Setpoint> travel(double seconds, bool rest_at_end = true) {
    const double now = port().now(), from = position(), ramp = 0.1;
    std::vector<Setpoint> setpoints;
    const auto count = static_cast<int>(std::lround(seconds / kCycle));
    for (int i = 1; i <= count; ++i) {
      const double t = i * kCycle, left = seconds - t;
      double x = kSpeed * (t < ramp ? t * t / (2 * ramp) : t - ramp / 2);
      double v = kSpeed * std::min(1.0, t / ramp);
      if (rest_at_end && left < ramp) {
        x = kSpeed * (seconds - ramp) - kSpeed * left * left / (2 * ramp);
        v = kSpeed * left / ramp;
      }
      setpoints.push_back(at(now + t, from + x, v));
    }
    if (rest_at_end) setpoints.back().velocity = {};
    return setpoints;
  }
  Status submit(const std::vector<Setpoint>& setpoints) { return port().submit(setpoints, kNever); }
  Status wait(double seconds) { return port().wait_until(port().now() + seconds); }

 private:
  std::unique_ptr<PortOnTrial> trial_ = GetParam()();
  const AxisVector start_ = trial_->port().state().position;
};

TEST_P(PortConformance, BeginsAtRestWithAnEmptyQueue) {
  const AxisState s = port().state();
  EXPECT_EQ(s.fault, Fault::none);
  EXPECT_FALSE(s.moving);
  EXPECT_EQ(s.accepted, 0U);
  EXPECT_EQ(s.executed, 0U);
  EXPECT_EQ(s.free_slots, trial().capacity);
  EXPECT_EQ(s.time, port().now());
  EXPECT_LE(s.sampled_at, s.time);
}

TEST_P(PortConformance, AcceptedIsNotExecuted) {
  ASSERT_EQ(submit(travel(0.3)), Status::ok);
  EXPECT_EQ(port().state().accepted, 300U);
  EXPECT_EQ(port().state().executed, 0U);
  EXPECT_EQ(port().state().free_slots, trial().capacity - 300);
  EXPECT_TRUE(port().state().moving);
  ASSERT_EQ(wait(0.15), Status::ok);
  EXPECT_LE(static_cast<double>(port().state().executed),
            151 + trial().clock_step / kCycle - earlier_by() / kCycle);
  EXPECT_GE(static_cast<double>(port().state().executed), 149 - (trial().clock_step + later_by()) / kCycle);
  ASSERT_EQ(wait(0.2 + trial().latency), Status::ok);
  EXPECT_EQ(port().state().executed, 300U);
  EXPECT_FALSE(port().state().moving);
  EXPECT_NEAR(position(), kSpeed * 0.2, slack());
}

TEST_P(PortConformance, FollowsACubicBetweenSetpoints) {
  const double depth = 5e-3, begin = port().now();
  const auto x = [&](double t) { return depth * t * t * (3 - 2 * t); };  // rests at both ends
  const auto v = [&](double t) { return depth * 6 * (t - t * t); };
  ASSERT_EQ(submit({at(begin + 0.25, x(0.25), v(0.25)), at(begin + 0.75, x(0.75), v(0.75)),
                    at(begin + 1, x(1), v(1))}),
            Status::ok);
  for (double t = 0.01; t < 1; t += 0.01) {
    ASSERT_EQ(port().wait_until(begin + t), Status::ok);
    expect_on_the_way(x(std::max(0.0, t - later_by())), x(std::max(0.0, t - earlier_by())), 1.5 * depth);
  }
}

TEST_P(PortConformance, RestsUntilAnIdleQueueIsFedAgain) {
  ASSERT_EQ(submit({at(port().now() + 0.1, 1e-3)}), Status::ok);
  ASSERT_EQ(wait(5), Status::ok);
  const double begin = port().now();
  ASSERT_EQ(submit({at(begin + 0.2, 2e-3)}), Status::ok);
  ASSERT_EQ(port().wait_until(begin + 0.1), Status::ok);
  const auto x = [](double t) { return 1e-3 * (1 + std::pow(t / 0.2, 2) * (3 - 2 * t / 0.2)); };
  expect_on_the_way(x(std::max(0.0, 0.1 - later_by())), x(0.1 - earlier_by()), 7.5e-3);
  ASSERT_EQ(port().wait_until(begin + 0.2 + trial().latency), Status::ok);
  EXPECT_NEAR(position(), 2e-3, slack());
}

TEST_P(PortConformance, AFullQueueTakesNothingOfTheCall) {
  std::vector<Setpoint> most;
  const double begin = port().now();
  for (std::size_t i = 1; i < trial().capacity; ++i)
    most.push_back(at(begin + kCycle * static_cast<double>(i), 0));
  ASSERT_EQ(submit(most), Status::ok);
  EXPECT_EQ(port().state().free_slots, 1U);
  const double end = most.back().time;
  const std::vector<Setpoint> two = {at(end + kCycle, 0), at(end + 2 * kCycle, 0)};
  EXPECT_EQ(submit(two), Status::queue_full);
  EXPECT_EQ(port().state().accepted, most.size());
  ASSERT_EQ(wait(5 * kCycle), Status::ok);
  EXPECT_EQ(submit(two), Status::ok);
}

TEST_P(PortConformance, RejectsWhatCannotBeMeant) {
  const double now = port().now(), nan = std::nan(""), endless = std::numeric_limits<double>::infinity();
  const auto rejected = [&](const Setpoint& last) {
    return submit({at(now + 1, 0), last}) == Status::rejected;
  };
  EXPECT_TRUE(rejected(at(now + 1, 0))) << "a time that does not increase";
  EXPECT_TRUE(rejected(at(nan, 0)));
  EXPECT_TRUE(rejected(at(endless, 0)));
  EXPECT_TRUE(rejected(at(now + 2, nan)));
  EXPECT_TRUE(rejected(at(now + 2, 0, endless)));
  Setpoint fed = at(now + 2, 0);
  fed.filament = nan;
  EXPECT_TRUE(rejected(fed));
  Setpoint far = at(now + 2, 0);
  far.position[0] = trial().range.upper + 1e-6;
  EXPECT_TRUE(rejected(far));
  far.position[0] = trial().range.lower - 1e-6;
  EXPECT_TRUE(rejected(far));
  EXPECT_EQ(submit({at(now, 0)}), Status::rejected) << "a time that has passed";
  std::vector<Setpoint> more;  // than ever fits: waiting does not help
  for (std::size_t i = 0; i <= trial().capacity; ++i)
    more.push_back(at(now + kCycle * static_cast<double>(i + 1), 0));
  EXPECT_EQ(submit(more), Status::rejected);
  EXPECT_EQ(port().state().accepted, 0U);
}

TEST_P(PortConformance, RunningDryInMotionIsAStickyUnderrun) {
  ASSERT_EQ(submit(travel(0.2, false)), Status::ok);
  EXPECT_EQ(wait(1), Status::faulted);
  EXPECT_EQ(port().state().fault, Fault::underrun);
  EXPECT_FALSE(port().state().moving);
  const double stopped = port().now();
  EXPECT_EQ(wait(1), Status::faulted);
  EXPECT_EQ(port().now(), stopped) << "the clock stands";
  EXPECT_EQ(submit({at(stopped + 1, 0)}), Status::faulted);
  ASSERT_EQ(port().urgent(UrgentCommand::clear_fault), Status::ok);
  EXPECT_EQ(port().state().fault, Fault::none);
  const double rest = position();
  EXPECT_NEAR(rest, kSpeed * 0.15, slack());
  ASSERT_EQ(submit({at(port().now() + 0.5, rest)}), Status::ok);
  EXPECT_EQ(wait(1), Status::ok);
}

TEST_P(PortConformance, AfterAFaultOutputsCanOnlyBeSwitchedOff) {
  ASSERT_EQ(port().set_outputs({483, 0.5}, kNever), Status::ok);
  ASSERT_EQ(submit(travel(0.2, false)), Status::ok);
  ASSERT_EQ(wait(1), Status::faulted);
  EXPECT_EQ(port().set_outputs({483, 0}, kNever), Status::faulted);
  EXPECT_EQ(port().set_outputs({}, kNever), Status::ok);
}

TEST_P(PortConformance, HoldBrakesAndKeepsTheQueueUntilResume) {
  ASSERT_EQ(submit(travel(0.8)), Status::ok);
  ASSERT_EQ(wait(0.3), Status::ok);
  const double before = trial().drift > 0 ? travelled(0.3) : position();
  ASSERT_EQ(port().urgent(UrgentCommand::hold), Status::ok);
  ASSERT_EQ(wait(2), Status::ok);
  EXPECT_GE(position() - before, kSpeed * kBraking / 2 - slack());
  EXPECT_LE(position() - before, kSpeed * (kBraking / 2 + trial().latency) + slack());
  EXPECT_FALSE(port().state().moving);
  EXPECT_LT(port().state().executed, 400U);
  ASSERT_EQ(port().urgent(UrgentCommand::resume), Status::ok);
  // Starting again is many short blocks: a controller that takes a line late takes each of them late.
  ASSERT_EQ(wait(2 + 3 * trial().latency), Status::ok);
  EXPECT_EQ(port().state().executed, 800U);
  EXPECT_NEAR(position(), kSpeed * 0.7, slack());
}

TEST_P(PortConformance, StopBrakesAlongTheQueueAndDropsIt) {
  ASSERT_EQ(submit(travel(0.8)), Status::ok);
  ASSERT_EQ(wait(0.3), Status::ok);
  const double before = trial().drift > 0 ? travelled(0.3) : position();
  ASSERT_EQ(port().urgent(UrgentCommand::stop), Status::ok);
  EXPECT_TRUE(port().state().moving) << "a stop is not instant";
  ASSERT_EQ(wait(0.5 + trial().latency), Status::ok);
  EXPECT_GE(position() - before, kSpeed * kBraking / 2 - slack());
  EXPECT_LE(position() - before, kSpeed * (kBraking / 2 + trial().latency) + slack());
  const AxisState rest = port().state();
  EXPECT_FALSE(rest.moving);
  EXPECT_EQ(rest.free_slots, trial().capacity);
  EXPECT_EQ(rest.accepted, 800U);
  EXPECT_LT(rest.executed, 400U) << "what is dropped is not executed";
  ASSERT_EQ(submit({at(port().now() + 0.5, position())}), Status::ok);
  EXPECT_EQ(wait(0.6), Status::ok);
}

TEST_P(PortConformance, AStopIsNotUndoneByHoldOrResume) {
  ASSERT_EQ(submit(travel(0.8)), Status::ok);
  ASSERT_EQ(wait(0.3), Status::ok);
  ASSERT_EQ(port().urgent(UrgentCommand::stop), Status::ok);
  ASSERT_EQ(port().urgent(UrgentCommand::resume), Status::ok);
  ASSERT_EQ(port().urgent(UrgentCommand::hold), Status::ok);
  ASSERT_EQ(wait(2), Status::ok);
  EXPECT_EQ(port().state().free_slots, trial().capacity);
}

TEST_P(PortConformance, AStopAtRestDropsNothingThatComesAfterIt) {
  ASSERT_EQ(port().urgent(UrgentCommand::stop), Status::ok);
  ASSERT_EQ(submit(travel(0.4)), Status::ok);
  ASSERT_EQ(wait(0.6 + trial().latency), Status::ok);
  EXPECT_EQ(port().state().executed, 400U);
}

TEST_P(PortConformance, TimePassesInWaitUntilAndCaptureAlone) {
  const double now = port().now();
  ASSERT_EQ(submit(travel(0.2)), Status::ok);
  ASSERT_EQ(port().urgent(UrgentCommand::hold), Status::ok);
  ASSERT_EQ(port().urgent(UrgentCommand::resume), Status::ok);
  ASSERT_EQ(port().set_outputs({483, 1}, kNever), Status::ok);
  static_cast<void>(port().state());
  EXPECT_EQ(port().now(), now);
  ASSERT_EQ(port().wait_until(now - 1), Status::ok);
  EXPECT_EQ(port().now(), now) << "a time that has passed";
  ASSERT_EQ(port().wait_until(now + 0.1), Status::ok);
  EXPECT_NEAR(port().now(), now + 0.1, trial().clock_step);
}

TEST_P(PortConformance, EveryCallKeepsItsDeadline) {
  ASSERT_EQ(wait(1), Status::ok);
  const double now = port().now();
  Frame frame;
  EXPECT_EQ(port().submit(std::array{at(now + 1, 0)}, now - 0.5), Status::deadline_exceeded);
  EXPECT_EQ(port().set_outputs({}, now - 0.5), Status::deadline_exceeded);
  if (trial().camera) {
    EXPECT_EQ(port().capture({0, 0, 4, 4}, frame, now + 1e-6), Status::deadline_exceeded);
  }
  EXPECT_EQ(port().now(), now);
}

TEST_P(PortConformance, AFrameShowsTheMiddleOfItsExposureAndCostsItsTime) {
  if (!trial().camera) GTEST_SKIP() << "a port without a camera";
  const Region region{10, 20, 30, 40};
  Frame frame;
  for (std::uint64_t number = 0; number < 3; ++number) {
    const double asked = port().now();
    ASSERT_EQ(port().capture(region, frame, kNever), Status::ok);
    EXPECT_EQ(frame.number, number);
    EXPECT_EQ(frame.image.region, region);
    EXPECT_GT(frame.exposed_at, asked);
    EXPECT_LT(frame.exposed_at, frame.received_at);
    EXPECT_EQ(frame.received_at, port().now());
  }
}

TEST_P(PortConformance, ALostFrameCostsItsTimeAndTakesNoNumber) {
  if (!trial().camera) GTEST_SKIP() << "a port without a camera";
  Frame frame;
  trial().lose_frames(true);
  const double asked = port().now();
  EXPECT_EQ(port().capture({0, 0, 4, 4}, frame, kNever), Status::no_frame);
  EXPECT_GT(port().now(), asked);
  trial().lose_frames(false);
  ASSERT_EQ(port().capture({0, 0, 4, 4}, frame, kNever), Status::ok);
  EXPECT_EQ(frame.number, 0U);
}

TEST_P(PortConformance, AFrameIsNotWaitedForThroughAFault) {
  if (!trial().camera) GTEST_SKIP() << "a port without a camera";
  ASSERT_EQ(submit(travel(0.2, false)), Status::ok);
  ASSERT_EQ(wait(1), Status::faulted);
  Frame frame;
  EXPECT_EQ(port().capture({0, 0, 4, 4}, frame, kNever), Status::faulted);
}

}  // namespace understudy::machine

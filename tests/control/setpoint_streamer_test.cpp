#include "control/setpoint_streamer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/interrupt.h"
#include "machine/loopback_port.h"

namespace understudy::control {
namespace {

using machine::LoopbackPort;
using machine::Setpoint;
using machine::Status;

constexpr double kCycle = 1e-3;     // [s], of which sums are rounded: some setpoints are late by that
constexpr double kVelocity = 0.01;  // [m/s]

/// Axis 1 at a steady pace from 0 on; the last of `count` is at rest.
Setpoint setpoint_at(int k, int count) {
  Setpoint s;
  s.time = kCycle * k;
  s.position[0] = kVelocity * s.time;
  s.velocity[0] = k == count ? 0 : kVelocity;
  return s;
}

Stop stream(SetpointStreamer& streamer, int count) {
  for (int k = 1; k <= count; ++k) {
    streamer.add(setpoint_at(k, count));
    if (!streamer.full()) continue;
    if (Stop stop = streamer.write()) return stop;
  }
  return streamer.write();
}

LoopbackPort port_with_room_for(std::size_t setpoints) {
  LoopbackPort::Options options;
  options.queue_capacity = setpoints;
  return LoopbackPort(options);
}

TEST(SetpointStreamer, ABatchIsHalfOfASmallQueueOr256) {
  for (const auto& [room, batch] : {std::pair{1u, 1}, {10u, 5}, {4096u, 256}}) {
    LoopbackPort port = port_with_room_for(room);
    SetpointStreamer streamer(port, kCycle);
    int added = 0;
    for (; !streamer.full(); ++added) streamer.add(setpoint_at(added + 1, 1000));
    EXPECT_EQ(added, batch) << "a queue of " << room;
  }
}

TEST(SetpointStreamer, TheLineExecutedIsBehindWhatWasHandedOver) {
  LoopbackPort port({});
  SetpointStreamer streamer(port, kCycle);
  EXPECT_EQ(streamer.line_executed(), 0);
  for (int k = 1; k <= 600; ++k) {  // line 1 up to 100 ms, line 2 up to 200 ms, and so on
    Setpoint s = setpoint_at(k, 600);
    s.line = 1 + (k - 1) / 100;
    streamer.add(s);
    if (!streamer.full()) continue;
    ASSERT_FALSE(streamer.write());
  }
  ASSERT_FALSE(streamer.write());
  for (const auto& [time, line] : {std::pair{0.0, 1}, {0.0505, 1}, {0.1505, 2}, {0.5505, 6}, {0.7, 6}}) {
    ASSERT_EQ(port.wait_until(time), Status::ok);
    EXPECT_EQ(streamer.line_executed(), line) << time;
  }
  Setpoint more = setpoint_at(900, 900);
  more.position[0] = kVelocity * 0.6;
  more.line = 9;
  streamer.add(more);
  ASSERT_FALSE(streamer.write());
  EXPECT_EQ(streamer.line_executed(), 9) << "on its way there";
}

TEST(SetpointStreamer, NothingReachesThePortBeforeItIsWritten) {
  LoopbackPort port({});
  SetpointStreamer streamer(port, kCycle);
  streamer.add(setpoint_at(1, 1));
  EXPECT_EQ(port.state().accepted, 0u);
  EXPECT_FALSE(streamer.write());
  EXPECT_FALSE(streamer.write()) << "nothing is handed over twice";
  EXPECT_EQ(port.state().accepted, 1u);
}

TEST(SetpointStreamer, WaitsForAFullQueueAndLosesNothing) {
  LoopbackPort port = port_with_room_for(10);
  SetpointStreamer streamer(port, kCycle);
  const Stop stop = stream(streamer, 100);
  ASSERT_FALSE(stop) << stop.why << ' ' << stop.time;
  EXPECT_GE(port.now(), 90 * kCycle) << "the queue holds ten cycles: 90 of 100 had to be over";
  ASSERT_FALSE(streamer.wait_until_executed());
  ASSERT_EQ(port.history().size(), 100u);
  for (int k = 1; k <= 100; ++k) EXPECT_EQ(port.history()[static_cast<std::size_t>(k - 1)].time, kCycle * k);
  EXPECT_GE(port.now(), 100 * kCycle);
}

/// A port whose clock moves by two cycles or not at all, as a plant of a larger time step does.
class CoarseClockPort : public LoopbackPort {
 public:
  using LoopbackPort::LoopbackPort;
  Status wait_until(double time) override {
    const double tick = 2 * kCycle;
    if (++waits > 1000) return Status::deadline_exceeded;
    return LoopbackPort::wait_until(tick * std::floor(time / tick + 1e-9));
  }
  int waits = 0;
};

TEST(SetpointStreamer, AClockCoarserThanTheCycleIsWaitedFor) {
  LoopbackPort::Options options;
  options.queue_capacity = 10;
  CoarseClockPort port(options);
  SetpointStreamer streamer(port, kCycle);
  const Stop stop = stream(streamer, 100);
  ASSERT_FALSE(stop) << stop.why << " after " << port.waits << " waits";
  ASSERT_FALSE(streamer.wait_until_executed());
  EXPECT_EQ(port.history().size(), 100u);
}

TEST(SetpointStreamer, AHeldMachineIsGivenUpAfterHalfAMinute) {
  LoopbackPort port = port_with_room_for(10);
  SetpointStreamer streamer(port, kCycle);
  ASSERT_EQ(port.urgent(machine::UrgentCommand::hold), Status::ok);
  ASSERT_EQ(port.wait_until(machine::kBrakingTime), Status::ok);
  for (int k = 200; k < 205; ++k) streamer.add(setpoint_at(k, 204));
  ASSERT_FALSE(streamer.write());
  const Stop stop = streamer.wait_until_executed();
  EXPECT_EQ(stop.status, Status::deadline_exceeded);
  EXPECT_NEAR(stop.time, 204 * kCycle + 30, 0.05);  // polled every 10 ms
  for (int k = 205; k < 215; ++k) streamer.add(setpoint_at(k + 100000, 0));
  EXPECT_EQ(streamer.write().status, Status::deadline_exceeded) << "there is room for five";
}

TEST(SetpointStreamer, BrakingDropsTheRestAndDoesNotWaitForIt) {
  LoopbackPort port({});
  SetpointStreamer streamer(port, kCycle);
  ASSERT_FALSE(stream(streamer, 1000));
  ASSERT_EQ(port.wait_until(0.2), Status::ok);
  ASSERT_FALSE(streamer.brake());
  EXPECT_FALSE(port.state().moving);
  // Straight from full speed to rest: half of the way that full speed would make in that time.
  EXPECT_NEAR(port.state().position[0], kVelocity * (0.2 + machine::kBrakingTime / 2), kVelocity * kCycle);
  EXPECT_LT(port.state().executed, 300u);
  EXPECT_FALSE(streamer.wait_until_executed());
  EXPECT_LT(port.now(), 1.1);
}

TEST(SetpointStreamer, AFaultEndsTheWait) {
  LoopbackPort port({});
  SetpointStreamer streamer(port, kCycle);
  ASSERT_FALSE(stream(streamer, 1000));
  port.inject_fault(machine::Fault::drive, 0.3);
  const Stop stop = streamer.wait_until_executed();
  EXPECT_EQ(stop.status, Status::faulted);
  EXPECT_EQ(stop.fault, machine::Fault::drive);
  EXPECT_NEAR(stop.time, 0.3, 1e-9);
}

TEST(SetpointStreamer, AnInterruptIsNotSleptThrough) {
  LoopbackPort port({});
  SetpointStreamer streamer(port, kCycle);
  ASSERT_FALSE(stream(streamer, 1000));
  set_interrupted(true);
  EXPECT_THROW((void)streamer.wait_until_executed(), Interrupted);
  set_interrupted(false);
  EXPECT_EQ(port.now(), 0);
}

}  // namespace
}  // namespace understudy::control

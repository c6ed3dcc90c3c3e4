// The queue alone; what it does under a port is in port_conformance.h.
#include "machine/setpoint_queue.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::machine {
namespace {

SetpointQueue one_axis(std::size_t capacity) {
  SetpointQueueOptions options;
  options.capacity = capacity;
  options.ranges = {{-10, 10}};
  options.rest_velocity[0] = 1e-6;
  return SetpointQueue(options, {}, 0);
}

Setpoint at(double time, double position, double velocity = 0) {
  Setpoint s;
  s.time = time;
  s.position[0] = position;
  s.velocity[0] = velocity;
  s.filament = position / 2;
  return s;
}

TEST(SetpointQueue, InterpolatesPositionVelocityAndFilament) {
  auto queue = one_axis(8);
  const std::array path = {at(1, 1, 3), at(2, 8, 12)};  // t^3
  ASSERT_EQ(queue.submit(path, 0), Status::ok);
  for (double t = 0.05; t < 2; t += 0.05) {
    const auto& target = queue.advance_to(t);
    // From rest at 0 to slope 3 at 1 the cubic is t^3 as well; rounding only.
    ASSERT_NEAR(target.position[0], t * t * t, 1e-12) << t;
    ASSERT_NEAR(target.velocity[0], 3 * t * t, 1e-12) << t;
  }
  EXPECT_NEAR(queue.advance_to(1.5).filament, 0.5 * (0.5 + 4), 1e-12);
}

TEST(SetpointQueue, GoesRoundItsRingInOrder) {
  auto queue = one_axis(7);
  Random random(3, "setpoint queue");
  double submitted = 0, executed = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<Setpoint> some;
    const auto count = static_cast<std::size_t>(random.uniform(0, 5));
    for (std::size_t i = 0; i < count; ++i) some.push_back(at(submitted + 1 + static_cast<double>(i), 0));
    const bool room = count <= queue.free_slots();
    ASSERT_EQ(queue.submit(some, executed), room ? Status::ok : Status::queue_full);
    if (room) submitted += static_cast<double>(count);
    const double now = std::min(submitted, executed + std::floor(random.uniform(0, 4)));
    while (const Setpoint* next = queue.execute_next(now)) ASSERT_EQ(next->time, ++executed);
    ASSERT_EQ(executed, now);
    ASSERT_EQ(static_cast<double>(queue.accepted()), submitted);
    ASSERT_EQ(static_cast<double>(queue.executed()), executed);
  }
  EXPECT_GT(executed, 500);
}

TEST(SetpointQueue, SlowsDownLinearlyAndLagsBehindWhatItMissed) {
  auto queue = one_axis(16);
  ASSERT_EQ(queue.submit(std::array{at(1, 1, 1), at(2, 2, 1), at(3, 3, 0)}, 0), Status::ok);
  queue.advance_to(1.5);
  queue.hold();
  const double dt = 1e-4;
  double now = 1.5;
  for (int i = 0; i < 2000; ++i) {
    now += dt;
    queue.pass(dt, now);
    queue.advance_to(now);
  }
  // Half of the braking time at full speed, to a step of the ramp.
  EXPECT_NEAR(queue.target().position[0], 1.5 + kBrakingTime / 2, 2 * dt);
  EXPECT_NEAR(queue.lag(), 0.2 - kBrakingTime / 2, 2 * dt);
  EXPECT_EQ(queue.target().velocity[0], 0);
  EXPECT_FALSE(queue.moving());
}

TEST(SetpointQueue, WhatIsQueuedAfterItHasRunEmptyBehindAHoldIsNotLate) {
  auto queue = one_axis(16);
  ASSERT_EQ(queue.submit(std::array{at(1, 1, 0)}, 0), Status::ok);
  queue.hold();
  const double dt = 1e-3;
  double now = 0;
  const auto run_to = [&](double end) {
    for (; now < end; now += dt) {
      queue.pass(dt, now + dt);
      queue.advance_to(now + dt);
    }
  };
  run_to(0.5);
  queue.resume();
  run_to(3);
  ASSERT_EQ(queue.executed(), 1U);
  ASSERT_NEAR(queue.lag(), 0.5, 2 * kBrakingTime);
  ASSERT_EQ(queue.submit(std::array{at(now - 0.1, 2)}, now), Status::rejected);  // it is not after now
  ASSERT_EQ(queue.submit(std::array{at(now + 1, 2, 0)}, now), Status::ok);
  EXPECT_EQ(queue.lag(), 0);
  EXPECT_NEAR(queue.advance_to(now + 0.5).position[0], 1.5, 1e-9);  // halfway, by symmetry
  queue.advance_to(now + 1);
  EXPECT_EQ(queue.executed(), 2U);
}

TEST(SetpointQueue, AFaultLeavesTheAxesAtTheTarget) {
  auto queue = one_axis(16);
  ASSERT_EQ(queue.submit(std::array{at(1, 1, 1), at(2, 2, 0)}, 0), Status::ok);
  const double there = queue.advance_to(1.5).position[0];
  queue.clear(1.5);
  EXPECT_EQ(queue.free_slots(), 16U);
  EXPECT_FALSE(queue.ran_dry());
  EXPECT_EQ(queue.advance_to(4).position[0], there);
  EXPECT_EQ(queue.executed(), 1U);
}

}  // namespace
}  // namespace understudy::machine

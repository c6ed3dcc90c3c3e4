#include "machine/loopback_port.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace understudy::machine {
namespace {

constexpr double kNever = 1e9;

Setpoint at(double time, double position, double velocity = 0) {
  Setpoint s;
  s.time = time;
  s.position[0] = position;
  s.velocity[0] = velocity;
  return s;
}

LoopbackPort one_axis(std::size_t capacity = 16) {
  LoopbackPort::Options options;
  options.axis_count = 1;
  options.queue_capacity = capacity;
  return LoopbackPort(options);
}

TEST(LoopbackPort, AcceptedIsNotExecuted) {
  auto port = one_axis();
  const Setpoint path[] = {at(0.1, 1), at(0.2, 2)};
  ASSERT_EQ(port.submit(path, kNever), Status::ok);
  EXPECT_EQ(port.state().accepted, 2u);
  EXPECT_EQ(port.state().executed, 0u);
  EXPECT_TRUE(port.state().moving);
  ASSERT_EQ(port.wait_until(0.15), Status::ok);
  EXPECT_EQ(port.state().executed, 1u);
  ASSERT_EQ(port.wait_until(0.2), Status::ok);
  EXPECT_EQ(port.state().executed, 2u);
  EXPECT_FALSE(port.state().moving);
  EXPECT_DOUBLE_EQ(port.state().position[0], 2);
}

TEST(LoopbackPort, FollowsACubicExactlyBetweenSetpoints) {
  auto port = one_axis();
  const auto x = [](double t) { return t * t * (3 - 2 * t); };  // rests at both ends
  const auto v = [](double t) { return 6 * t - 6 * t * t; };
  const Setpoint path[] = {at(0.25, x(0.25), v(0.25)), at(0.75, x(0.75), v(0.75)), at(1, x(1), v(1))};
  ASSERT_EQ(port.submit(path, kNever), Status::ok);
  for (double t = 0.01; t < 1; t += 0.01) {
    ASSERT_EQ(port.wait_until(t), Status::ok);
    EXPECT_NEAR(port.state().position[0], x(t), 1e-12) << t;  // rounding only
  }
}

TEST(LoopbackPort, RestsUntilAnIdleQueueIsFedAgain) {
  auto port = one_axis();
  ASSERT_EQ(port.submit(std::array{at(0.1, 1)}, kNever), Status::ok);
  ASSERT_EQ(port.wait_until(5), Status::ok);
  ASSERT_EQ(port.submit(std::array{at(5.2, 2)}, kNever), Status::ok);
  ASSERT_EQ(port.wait_until(5.1), Status::ok);
  EXPECT_NEAR(port.state().position[0], 1.5, 1e-12);  // rounding of the clock
}

TEST(LoopbackPort, AFullQueueTakesNothingOfTheCall) {
  auto port = one_axis(3);
  ASSERT_EQ(port.submit(std::array{at(1, 1), at(2, 2)}, kNever), Status::ok);
  EXPECT_EQ(port.state().free_slots, 1u);
  EXPECT_EQ(port.submit(std::array{at(3, 3), at(4, 4)}, kNever), Status::queue_full);
  EXPECT_EQ(port.state().accepted, 2u);
  ASSERT_EQ(port.wait_until(1), Status::ok);
  EXPECT_EQ(port.submit(std::array{at(3, 3), at(4, 4)}, kNever), Status::ok);
}

TEST(LoopbackPort, RejectsWhatCannotBeMeant) {
  auto port = one_axis();
  EXPECT_EQ(port.submit(std::array{at(0, 1)}, kNever), Status::rejected);
  EXPECT_EQ(port.submit(std::array{at(1, 1), at(1, 2)}, kNever), Status::rejected);
  EXPECT_EQ(port.submit(std::array{at(1, std::nan(""))}, kNever), Status::rejected);
  EXPECT_EQ(port.submit(std::array{at(1, 1, std::numeric_limits<double>::infinity())}, kNever),
            Status::rejected);
  EXPECT_EQ(port.state().accepted, 0u);
}

TEST(LoopbackPort, RunningDryInMotionIsAStickyUnderrun) {
  auto port = one_axis();
  ASSERT_EQ(port.submit(std::array{at(0.1, 1, 5)}, kNever), Status::ok);
  EXPECT_EQ(port.wait_until(1), Status::faulted);
  EXPECT_EQ(port.state().fault, Fault::underrun);
  EXPECT_DOUBLE_EQ(port.now(), 0.1);
  EXPECT_EQ(port.submit(std::array{at(2, 1)}, kNever), Status::faulted);
  EXPECT_EQ(port.wait_until(2), Status::faulted);
  ASSERT_EQ(port.urgent(UrgentCommand::clear_fault), Status::ok);
  EXPECT_EQ(port.submit(std::array{at(2, 1)}, kNever), Status::ok);
}

TEST(LoopbackPort, AnInjectedFaultStopsTheAxesAtItsTime) {
  auto port = one_axis();
  port.inject_fault(Fault::emergency_stop, 0.5);
  ASSERT_EQ(port.submit(std::array{at(1, 1)}, kNever), Status::ok);
  EXPECT_EQ(port.wait_until(2), Status::faulted);
  EXPECT_DOUBLE_EQ(port.now(), 0.5);
  EXPECT_DOUBLE_EQ(port.state().position[0], 0.5);
  EXPECT_EQ(port.state().fault, Fault::emergency_stop);
  EXPECT_EQ(port.set_outputs({483, 0}, kNever), Status::faulted);
  EXPECT_EQ(port.set_outputs({}, kNever), Status::ok);
}

TEST(LoopbackPort, HoldKeepsTheQueueAndStopDropsIt) {
  auto port = one_axis();
  ASSERT_EQ(port.submit(std::array{at(1, 1)}, kNever), Status::ok);
  ASSERT_EQ(port.wait_until(0.5), Status::ok);
  ASSERT_EQ(port.urgent(UrgentCommand::hold), Status::ok);
  ASSERT_EQ(port.wait_until(3.5), Status::ok);
  EXPECT_DOUBLE_EQ(port.state().position[0], 0.5);
  ASSERT_EQ(port.urgent(UrgentCommand::resume), Status::ok);
  ASSERT_EQ(port.wait_until(4), Status::ok);
  EXPECT_DOUBLE_EQ(port.state().position[0], 1);

  ASSERT_EQ(port.submit(std::array{at(5, 2)}, kNever), Status::ok);
  ASSERT_EQ(port.urgent(UrgentCommand::stop), Status::ok);
  ASSERT_EQ(port.wait_until(9), Status::ok);
  EXPECT_DOUBLE_EQ(port.state().position[0], 1);
}

TEST(LoopbackPort, AFrameIsExposedHalfWayAndNumbered) {
  LoopbackPort::Options options;
  options.frame_time = 0.02;
  LoopbackPort port(options, [](const AxisState& state, const Region& region, Image& image) {
    image.region = region;
    image.pixels.assign(1, static_cast<std::uint8_t>(state.time * 1000));
    return true;
  });
  Frame frame;
  ASSERT_EQ(port.capture({0, 0, 1, 1}, frame, 1), Status::ok);
  EXPECT_DOUBLE_EQ(frame.exposed_at, 0.01);
  EXPECT_DOUBLE_EQ(frame.received_at, 0.02);
  EXPECT_EQ(frame.image.at(0, 0), 10);
  const auto first = frame.number;
  ASSERT_EQ(port.capture({0, 0, 1, 1}, frame, 1), Status::ok);
  EXPECT_GT(frame.number, first);
  port.repeat_frames(1);
  const auto second = frame.number;
  ASSERT_EQ(port.capture({0, 0, 1, 1}, frame, 1), Status::ok);
  EXPECT_EQ(frame.number, second);
  EXPECT_GT(frame.received_at - frame.exposed_at, 0.02);
}

TEST(LoopbackPort, EveryCallKeepsItsDeadline) {
  auto port = one_axis();
  ASSERT_EQ(port.wait_until(1), Status::ok);
  Frame frame;
  EXPECT_EQ(port.submit(std::array{at(2, 1)}, 0.5), Status::deadline_exceeded);
  EXPECT_EQ(port.set_outputs({}, 0.5), Status::deadline_exceeded);
  EXPECT_EQ(port.capture({0, 0, 1, 1}, frame, 1.001), Status::deadline_exceeded);
  EXPECT_EQ(port.capture({0, 0, 1, 1}, frame, 2), Status::no_frame);
}

}  // namespace
}  // namespace understudy::machine

#include "machine/loopback_port.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/machine/port_conformance.h"
#include "tests/machine/port_properties.h"
#include "tests/machine/record/recorded_on_trial.h"

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

class LoopbackOnTrial : public PortOnTrial {
 public:
  LoopbackOnTrial()
      : port_(options(), [this](const AxisState&, const Region& region, Image& image) {
          image.region = region;
          image.pixels.assign(static_cast<std::size_t>(region.width * region.height), 7);
          return !lost_;
        }) {
    range = options().ranges[0];
    capacity = options().queue_capacity;
    clock_step = 0.5e-3;  // while it brakes; exact otherwise
  }
  MachinePort& port() override { return port_; }
  void lose_frames(bool lost) override { lost_ = lost; }

 private:
  static LoopbackPort::Options options() {
    LoopbackPort::Options options;
    options.axis_count = 2;
    options.queue_capacity = 1500;
    options.start[0] = 0.2;
    options.ranges = {{0.1, 0.3}, {-1, 1}};
    return options;
  }
  LoopbackPort port_;
  bool lost_ = false;
};

INSTANTIATE_TEST_SUITE_P(Recorded, PortConformance, testing::Values(+[]() -> std::unique_ptr<PortOnTrial> {
                           return std::make_unique<RecordedOnTrial>();
                         }));
INSTANTIATE_TEST_SUITE_P(Loopback, PortConformance, testing::Values(+[]() -> std::unique_ptr<PortOnTrial> {
                           return std::make_unique<LoopbackOnTrial>();
                         }));

TEST(LoopbackPortProperties, RandomOperationsGoAsTheModelSays) {
  expect_port_obeys_the_model(
      +[]() -> std::unique_ptr<PortOnTrial> { return std::make_unique<LoopbackOnTrial>(); }, {500, 40});
}

TEST(LoopbackPort, StandsAtTheVeryTimeAtWhichItsQueueRanDry) {
  auto port = one_axis();
  ASSERT_EQ(port.submit(std::array{at(0.1, 1, 5)}, kNever), Status::ok);
  EXPECT_EQ(port.wait_until(1), Status::faulted);
  EXPECT_DOUBLE_EQ(port.now(), 0.1);
  EXPECT_DOUBLE_EQ(port.state().position[0], 1);
}

TEST(LoopbackPort, KeepsEverySetpointThatItHasExecuted) {
  auto port = one_axis();
  ASSERT_EQ(port.submit(std::array{at(0.1, 1), at(0.2, 2), at(0.3, 2.5)}, kNever), Status::ok);
  ASSERT_EQ(port.wait_until(0.2), Status::ok);
  ASSERT_EQ(port.history().size(), 2U);
  EXPECT_EQ(port.history()[1].position[0], 2);
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

TEST(LoopbackPort, AFrameIsExposedHalfWayAndMayBeRepeated) {
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

TEST(LoopbackPort, HasNoFrameWithoutACamera) {
  auto port = one_axis();
  Frame frame;
  EXPECT_EQ(port.capture({0, 0, 1, 1}, frame, 2), Status::no_frame);
  EXPECT_EQ(port.now(), 0);
}

}  // namespace
}  // namespace understudy::machine

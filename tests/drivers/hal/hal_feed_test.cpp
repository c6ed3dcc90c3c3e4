#include "drivers/hal/hal_feed.h"

#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "machine/loopback_port.h"

namespace understudy::drivers {
namespace {

using machine::Fault;
using machine::Setpoint;
using machine::Status;
using machine::UrgentCommand;

constexpr double kNever = 1e9;
constexpr int kLead = 50;

/// Two axes; the figures are of no machine.
HalSettings two_axes() {
  HalSettings settings;
  settings.cycle = 1e-3;
  for (const char* name : {"x", "y"}) {
    HalAxis axis;
    axis.name = name;
    axis.scale = 100;
    settings.axes.push_back(axis);
  }
  settings.machine_axes = 2;
  return settings;
}

/// HAL as docs/linuxcnc.md tells it: takes a row a period, latches, has a watchdog, and drives that are at
/// the command a period later.
class ModelOfHal {
 public:
  static constexpr int kWatchdog = 20;  // [periods]
  static constexpr int kBrake = 10;     // [periods]

  HalSample sample() const { return sample_; }
  void send(const HalRow& row) { rows_.push_back(row); }
  std::size_t under_way() const { return rows_.size(); }
  HalSample period() {
    sample_.position = sample_.drives ? command_.position : sample_.position;
    const bool takes = sample_.on || !sample_.drives;
    if (takes && rows_.empty()) {
      ++sample_.underruns;
      ++starved_;
    }
    if (takes && !rows_.empty()) {
      starved_ = 0;
      const bool edge = rows_.front().reset && !command_.reset;
      command_ = rows_.front();
      rows_.pop_front();
      received.push_back(command_);
      if (edge && sample_.stop_released) sample_.on = sample_.drives = true;
    }
    sample_.starved = starved_ > kWatchdog;
    if (sample_.starved || !sample_.stop_released) sample_.on = false;
    off_ = sample_.on ? 0 : off_ + 1;
    if (off_ > kBrake) sample_.drives = false;
    sample_.number = command_.number;
    return sample_;
  }
  void emergency_stop(bool open) { sample_.stop_released = !open; }

  std::vector<HalRow> received;

 private:
  static HalSample first() {
    HalSample s;
    s.position = {10e-3, 20e-3};
    s.following = s.stop_released = true;
    return s;
  }
  HalSample sample_ = first();
  HalRow command_;
  std::deque<HalRow> rows_;
  int starved_ = 1000, off_ = 1000;
};

class HalFeedTest : public testing::Test {
 protected:
  HalFeedTest() : feed_(two_axes(), options(), hal_.sample()) {}
  void SetUp() override {
    feed_.switch_on();
    periods(100);
    ASSERT_TRUE(feed_.on());
    ASSERT_EQ(feed_.urgent(UrgentCommand::clear_fault), Status::ok);
    hal_.received.clear();
  }
  static HalFeedOptions options() {
    HalFeedOptions options;
    options.capacity = 5000;
    options.ranges = {{-1, 1}, {-1, 1}};
    options.lead = kLead;
    return options;
  }
  void send() {
    while (const auto row = feed_.next_row()) hal_.send(*row);
  }
  void periods(int count) {
    for (int i = 0; i < count; ++i) {
      send();
      feed_.take(hal_.period());
    }
  }
  Status wait(double seconds) {
    const double until = feed_.now() + seconds;
    feed_.wait_for(until);
    for (int i = 0; i < 100000 && !feed_.arrived(until); ++i) periods(1);
    feed_.wait_for(0);
    return feed_.fault() == Fault::none ? Status::ok : Status::faulted;
  }
  /// Out by `depth` and back, at rest at both ends.
  std::vector<Setpoint> there_and_back(double depth, int count) const {
    std::vector<Setpoint> setpoints;
    for (int i = 1; i <= count; ++i) {
      const double phase = 2 * std::numbers::pi * i / count;
      Setpoint s;
      s.time = feed_.now() + i * 1e-3;
      s.position = {10e-3 + depth * (1 - std::cos(phase)) / 2, 20e-3};
      s.velocity = {depth * std::sin(phase) / 2 * 2 * std::numbers::pi / (count * 1e-3), 0};
      if (i == count) s.velocity = {};
      setpoints.push_back(s);
    }
    return setpoints;
  }

  ModelOfHal hal_;
  HalFeed feed_;
};

TEST_F(HalFeedTest, KeepsTheLeadAndRestsWithoutTime) {
  const double now = feed_.now();
  periods(500);
  EXPECT_EQ(feed_.now(), now);
  EXPECT_EQ(feed_.fault(), Fault::none);
  EXPECT_LE(hal_.under_way(), static_cast<std::size_t>(kLead));
  for (const HalRow& row : hal_.received) EXPECT_EQ(row.position, hal_.received.front().position);
}

TEST_F(HalFeedTest, SendsARowForEachPeriodThatPasses) {
  ASSERT_EQ(feed_.submit(there_and_back(5e-3, 1200), kNever), Status::ok);
  ASSERT_EQ(wait(1.3), Status::ok);
  EXPECT_EQ(feed_.state().executed, 1200U);
  EXPECT_FALSE(feed_.state().moving);
  std::size_t first = 0;
  while (hal_.received[first].position[0] == 10e-3) ++first;
  const auto setpoints = there_and_back(5e-3, 1200);
  for (std::size_t i = 0; i < 1200; ++i)
    ASSERT_NEAR(hal_.received[first + i].position[0], setpoints[i].position[0], 1e-12) << i;
}

TEST_F(HalFeedTest, IsBehindTheClockByTheLeadInMotionAndFreshAtRest) {
  ASSERT_EQ(feed_.submit(there_and_back(5e-3, 300), kNever), Status::ok);
  ASSERT_EQ(wait(0.1), Status::ok);
  const machine::AxisState moving = feed_.state();
  EXPECT_NEAR(moving.time - moving.sampled_at, kLead * 1e-3, 3e-3);
  EXPECT_LT(moving.executed, 100U);
  ASSERT_EQ(wait(0.3), Status::ok);
  EXPECT_NEAR(feed_.state().time - feed_.state().sampled_at, 0, 1e-12);
}

TEST_F(HalFeedTest, TellsWhatEncodersBehindThePlayReadLastAndWhen) {
  machine::LoadReading reading;
  EXPECT_FALSE(feed_.read_load(reading)) << "a machine without";
  HalSettings settings = two_axes();
  settings.load_encoders = true;
  HalSample sample = hal_.sample();
  HalFeed feed(settings, options(), sample);
  sample.load = {10.02e-3, 19.97e-3};
  feed.take(sample);
  ASSERT_TRUE(feed.read_load(reading));
  EXPECT_EQ(reading.position, sample.load);
  EXPECT_EQ(reading.sampled_at, feed.state().sampled_at);
}

TEST_F(HalFeedTest, AControllerThatIsLateInMotionIsAnUnderrunAndOneAtRestIsNot) {
  ASSERT_EQ(feed_.submit(there_and_back(5e-3, 300), kNever), Status::ok);
  ASSERT_EQ(wait(0.1), Status::ok);
  periods(kLead + 2);
  EXPECT_EQ(feed_.fault(), Fault::underrun);
  EXPECT_GT(feed_.underruns(), 0U);
  EXPECT_EQ(feed_.submit(there_and_back(5e-3, 300), kNever), Status::faulted);
  periods(10);
  ASSERT_EQ(feed_.urgent(UrgentCommand::clear_fault), Status::ok);
  periods(1000);
  EXPECT_EQ(feed_.fault(), Fault::none);
}

TEST_F(HalFeedTest, AProcessThatStandsStillIsStoppedByTheWatchdog) {
  for (int i = 0; i < kLead + ModelOfHal::kWatchdog + 5; ++i) feed_.take(hal_.period());
  EXPECT_EQ(feed_.fault(), Fault::underrun);
  EXPECT_FALSE(feed_.on());
  EXPECT_EQ(feed_.urgent(UrgentCommand::clear_fault), Status::faulted)
      << "not before it is switched on again";
  EXPECT_FALSE(feed_.next_row().has_value()) << "nothing is said to a machine that is off";
}

TEST_F(HalFeedTest, AfterAStopOfTheMachineGoesOnFromWhereItStands) {
  ASSERT_EQ(feed_.submit(there_and_back(5e-3, 300), kNever), Status::ok);
  ASSERT_EQ(wait(0.12), Status::ok);
  hal_.emergency_stop(true);
  EXPECT_EQ(wait(1), Status::faulted);
  EXPECT_EQ(feed_.fault(), Fault::emergency_stop);
  const machine::AxisState stopped = feed_.state();
  EXPECT_LT(stopped.executed, 120U) << "what was under way was not executed";
  hal_.emergency_stop(false);
  ASSERT_TRUE(feed_.may_switch_on());
  feed_.switch_on();
  periods(100);
  ASSERT_TRUE(feed_.on());
  ASSERT_EQ(feed_.urgent(UrgentCommand::clear_fault), Status::ok);
  const double before = hal_.received.back().position[0];
  EXPECT_EQ(before, stopped.position[0]);
  Setpoint s;
  s.time = feed_.now() + 0.1;
  s.position = {before + 1e-3, 20e-3};
  ASSERT_EQ(feed_.submit(std::array{s}, kNever), Status::ok);
  ASSERT_EQ(wait(0.2), Status::ok);
  EXPECT_EQ(feed_.state().executed, stopped.executed + 1);
  EXPECT_EQ(feed_.state().position[0], s.position[0]);
}

TEST_F(HalFeedTest, AnOperatorsStopIsNotCleared) {
  feed_.stop_for_good("because");
  EXPECT_EQ(feed_.fault_text(), "because");
  EXPECT_EQ(feed_.urgent(UrgentCommand::clear_fault), Status::faulted);
  EXPECT_FALSE(feed_.next_row().has_value());
}

/// Random waits, holds, resumes and stops against a port that knows no HAL.
TEST_F(HalFeedTest, MovesAsTheLoopbackPortDoesUnderRandomCommands) {
  std::mt19937 random(3);
  machine::LoopbackPort::Options like;
  like.axis_count = 2;
  like.start = {10e-3, 20e-3};
  machine::LoopbackPort other(like);
  const auto both_wait = [&](double seconds) {
    ASSERT_EQ(wait(seconds), Status::ok);
    ASSERT_EQ(other.wait_until(feed_.now()), Status::ok);
  };
  for (int run = 0; run < 200; ++run) {
    const auto setpoints = there_and_back(3e-3, 200);
    ASSERT_EQ(feed_.submit(setpoints, kNever), Status::ok);
    ASSERT_EQ(other.submit(setpoints, kNever), Status::ok);
    for (int k = 0; k < 4; ++k) {
      both_wait(std::uniform_real_distribution(0.0, 0.08)(random));
      const auto command = std::array{UrgentCommand::hold, UrgentCommand::resume, UrgentCommand::hold,
                                      UrgentCommand::stop}[random() % (run % 10 == 0 ? 4 : 3)];
      ASSERT_EQ(feed_.urgent(command), Status::ok);
      ASSERT_EQ(other.urgent(command), Status::ok);
    }
    both_wait(0.2);
    ASSERT_EQ(feed_.urgent(UrgentCommand::stop), Status::ok);
    ASSERT_EQ(other.urgent(UrgentCommand::stop), Status::ok);
    both_wait(0.2);
    const auto here = feed_.state(), there = other.state();
    ASSERT_NEAR(here.position[0], there.position[0], 1e-12) << "run " << run;
    ASSERT_EQ(here.accepted, there.accepted);
    // The clocks are sums of other steps: a setpoint whose time is that of the stop may count or not.
    ASSERT_NEAR(static_cast<double>(here.executed), static_cast<double>(there.executed), run / 10 + 1)
        << "run " << run;
    // From here on as at the beginning: where a stop came to rest is somewhere else.
    Setpoint back;
    back.time = feed_.now() + 0.05;
    back.position = {10e-3, 20e-3};
    ASSERT_EQ(feed_.submit(std::array{back}, kNever), Status::ok);
    ASSERT_EQ(other.submit(std::array{back}, kNever), Status::ok);
    both_wait(0.1);
  }
  for (std::size_t i = 1; i < hal_.received.size(); ++i)
    ASSERT_EQ(hal_.received[i].number, hal_.received[i - 1].number + 1);
}

}  // namespace
}  // namespace understudy::drivers

#include "control/print.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using machine::Fault;
using machine::Status;
using testing::AllOf;
using testing::HasSubstr;
using toolpath::Program;
using toolpath::StepKind;

TEST(Print, NothingIsPrintedWithoutAKnownGap) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_frame_fault([](const Pose&, Image& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.line, 5);
  EXPECT_THAT(result.stop.why, AllOf(HasSubstr("no dot"), HasSubstr("retreated by 2.000 mm")));
  ASSERT_EQ(result.approaches.size(), 1u);
  EXPECT_EQ(result.approaches[0].outcome.stop, GapStop::no_dot);
  EXPECT_EQ(result.extruded, 0);
  EXPECT_NEAR(rig.commanded_now().translation().z(), kTable + kGap + 4e-3, 1e-6);  // S' and the retreat
  EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0) << "left hot";
  for (const auto& s : rig.port().history()) ASSERT_LE(s.filament, 0);
}

TEST(Print, AnEmergencyStopEndsIt) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(Fault::emergency_stop, 3.0);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.status, Status::faulted);
  EXPECT_EQ(result.stop.fault, Fault::emergency_stop);
  EXPECT_THAT(result.stop.why, HasSubstr("emergency stop"));
  EXPECT_GT(result.stop.line, 0);
  EXPECT_FALSE(rig.port().state().moving);
}

TEST(Print, AnEmergencyStopInTheBeadEndsIt) {
  // Without gap control the bead begins after about 1.6 s.
  for (double at : {2.0, 3.0}) {
    GapRig rig(hexapod(), low_by(0));
    rig.port().inject_fault(Fault::emergency_stop, at);
    PrintOptions options;
    options.gap_control = GapControl::off;
    const PrintResult result = print(bead_program(), hexapod(), rig.port(), options);
    EXPECT_FALSE(result.completed);
    EXPECT_EQ(result.stop.fault, Fault::emergency_stop);
    EXPECT_EQ(result.stop.line, rig.port().history().back().line) << "planned is the whole bead";
    EXPECT_LT(result.stop.line, 8);
    EXPECT_NEAR(result.duration, at, 1e-9);
    EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0) << "left hot";
    EXPECT_NEAR(rig.commanded_now().translation().z(), kTable + kGap, 1e-3);
  }
}

TEST(Print, AFaultThatStandsAlreadyIsNotIgnored) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(Fault::drive);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.fault, Fault::drive);
  EXPECT_THAT(result.stop.why, HasSubstr("drive fault"));
  EXPECT_TRUE(rig.port().history().empty());
}

/// A loopback port of which one call can be made to fail.
class WrongPort : public machine::LoopbackPort {
 public:
  explicit WrongPort(std::size_t capacity = 4096) : LoopbackPort(options(capacity)) {}
  Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override {
    largest_batch = std::max(largest_batch, setpoints.size());
    if (always_full) return now() > deadline ? Status::deadline_exceeded : Status::queue_full;
    if (reject_after-- == 0) return Status::rejected;
    const Status s = LoopbackPort::submit(setpoints, deadline);
    if (s == Status::queue_full) ++times_full;
    return s;
  }

  bool always_full = false;
  int reject_after = 1 << 30;
  int times_full = 0;
  std::size_t largest_batch = 0;

 private:
  static Options options(std::size_t capacity) {
    Options o;
    o.queue_capacity = capacity;
    const auto mechanism = hexapod().make_mechanism();
    EXPECT_EQ(mechanism->inverse(hexapod().X_BT_home, {}, std::span<double>(o.start.data(), 6)),
              kinematics::SolveStatus::ok);
    return o;
  }
};

TEST(Print, AShortQueueOnlyMakesItWait) {
  WrongPort large, small(64);
  ASSERT_TRUE(print(bead_program(), hexapod(), large, without_gap_control()).completed);
  ASSERT_TRUE(print(bead_program(), hexapod(), small, without_gap_control()).completed);
  EXPECT_GT(small.times_full, 10);
  EXPECT_LE(small.largest_batch, 64u);
  ASSERT_EQ(large.history().size(), small.history().size());
  for (std::size_t i = 0; i < large.history().size(); ++i) {
    ASSERT_EQ(large.history()[i].position, small.history()[i].position) << i;
    ASSERT_NEAR(large.history()[i].time, small.history()[i].time, 0.05) << i;
  }
}

TEST(Print, AQueueThatStaysFullIsGivenUp) {
  WrongPort port;
  port.always_full = true;
  const PrintResult result = print(bead_program(), hexapod(), port, without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.status, Status::deadline_exceeded);
  EXPECT_THAT(result.stop.why, HasSubstr("deadline exceeded"));
  EXPECT_LT(port.now(), 60);
}

TEST(Print, ARejectedBatchStopsTheMachine) {
  WrongPort port;
  port.reject_after = 5;
  const PrintResult result = print(bead_program(), hexapod(), port, without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.status, Status::rejected);
  ASSERT_EQ(port.wait_until(port.now() + 2 * machine::kBrakingTime), Status::ok);
  EXPECT_FALSE(port.state().moving) << "the rest of the queue still runs";
  EXPECT_EQ(port.outputs().nozzle_temperature, 0);
}

TEST(Print, AQueueThatRunsDryIsReported) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(Fault::underrun, 2.5);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_THAT(result.stop.why, HasSubstr("queue underrun"));
}

TEST(Print, AnInterruptStopsTheMachineAndLeavesNothingHot) {
  class Interrupter : public PrintObserver {
   public:
    void progress(std::size_t done, std::size_t, double) override {
      if (done == 6) set_interrupted(true);
    }
  } interrupter;
  GapRig rig(hexapod(), low_by(0));
  EXPECT_THROW(print(bead_program(), hexapod(), rig.port(), without_gap_control(), &interrupter),
               Interrupted);
  set_interrupted(false);
  ASSERT_EQ(rig.port().wait_until(rig.port().now() + 2 * machine::kBrakingTime), Status::ok);
  EXPECT_FALSE(rig.port().state().moving);
  EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0);
}

TEST(Print, AnInterruptIsHeardDuringTheApproach) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_frame_fault([](const Pose&, Image&) {
    set_interrupted(true);
    return true;
  });
  EXPECT_THROW(print(bead_program(), hexapod(), rig.port(), {}), Interrupted);
  set_interrupted(false);
  ASSERT_EQ(rig.port().wait_until(rig.port().now() + 2 * machine::kBrakingTime), Status::ok);
  EXPECT_FALSE(rig.port().state().moving);
}

TEST(Print, APoseOutOfReachStopsAtRestAndNamesTheStrut) {
  Program program = bead_program();
  program.steps[6] = step_to(StepKind::print, {0.2, 0, kTable + kGap}, 5e-3, 7, 1e-4);
  GapRig rig(hexapod(), low_by(0));
  const PrintResult result = print(program, hexapod(), rig.port(), without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.line, 7);
  EXPECT_THAT(result.stop.why, HasSubstr("strut"));
  EXPECT_EQ(rig.port().state().fault, Fault::none) << "the queue ran dry in motion";
  EXPECT_NEAR(rig.commanded_now().translation().x(), 5e-3, 1e-6) << "the last good step was not finished";
}

}  // namespace
}  // namespace understudy::control

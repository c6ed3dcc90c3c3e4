#include "control/print.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/approach.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "tests/control/gap_rig.h"

namespace understudy::control {
namespace {

using machine::Fault;
using machine::Status;
using testing::AllOf;
using testing::HasSubstr;
using toolpath::Program;
using toolpath::Step;
using toolpath::StepKind;

constexpr double kTable = 0.05;   // [m], height of the surface under the home tip
constexpr double kGap = 0.13e-3;  // [m], programmed

const machine::MachineDescription& hexapod() {
  static const auto machine = machine::load_machine("hexapod");
  return machine;
}

Step step_to(StepKind kind, const Vec3& p, double feed, int line, double filament = 0) {
  Step s;
  s.kind = kind;
  s.X_WT = make_pose(Quat::Identity(), p);
  s.feed = feed;
  s.line = line;
  s.filament = filament;
  return s;
}

/// Heat, S', S, 10 mm of bead along x, up.
Program bead_program() {
  Program program;
  program.file = "bead.gcode";
  Step heat, fan, end;
  heat.kind = StepKind::temperature;
  heat.temperature = 483;
  heat.line = 1;
  fan.kind = StepKind::fan;
  fan.fan = 0.5;
  fan.line = 2;
  end.kind = StepKind::end;
  end.line = 9;
  const double z = kTable + kGap;
  program.steps = {heat,
                   fan,
                   step_to(StepKind::travel, {0, 0, z + 5e-3}, 0, 3),
                   step_to(StepKind::travel, {0, 0, z + 2e-3}, 0, 4),
                   step_to(StepKind::move, {0, 0, z}, 2e-3, 5),
                   step_to(StepKind::print, {5e-3, 0, z}, 5e-3, 6, 1e-4),
                   step_to(StepKind::print, {10e-3, 0, z}, 5e-3, 7, 1e-4),
                   step_to(StepKind::move, {10e-3, 0, z + 5e-3}, 5e-3, 8, -1e-3),
                   end};
  return program;
}

DotWorld flat_part() { return plane_through(Vec3(0, 0, kTable), Vec3::UnitZ()); }
GapRigOptions low_by(double error) { return {flat_part(), Vec3(0, 0, error), Vec3::Zero(), 0.35, 1}; }

TEST(Print, CarriesTheOffsetOfTheStartAlongThePath) {
  GapRig rig(hexapod(), low_by(0.4e-3));
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  ASSERT_TRUE(result.completed) << result.stop_reason;
  ASSERT_EQ(result.approaches.size(), 1u);
  EXPECT_EQ(result.approaches[0].line, 5);
  EXPECT_EQ(result.approaches[0].outcome.stop, GapStop::none);
  ASSERT_EQ(result.offsets.size(), 1u);
  EXPECT_EQ(result.offsets[0].offset_W, result.approaches[0].outcome.offset_W);
  EXPECT_NEAR(result.offsets[0].offset_W.z(), -0.4e-3, 30e-6);
  int beads = 0;
  for (const auto& s : rig.port().history()) {
    if (s.line != 6 && s.line != 7) continue;
    ++beads;
    const double gap = rig.gap_at(rig.commanded(s.position));
    ASSERT_GT(gap, 0.1e-3) << "line " << s.line;
    ASSERT_LT(gap, 0.2e-3) << "line " << s.line;
  }
  // 10 mm at 5 mm/s take 2 s: 2000 cycles of 1 ms and the ramps.
  EXPECT_NEAR(beads, 2000, 30);
}

TEST(Print, WithoutGapControlGoesWhereTheProgramSays) {
  GapRig rig(hexapod(), low_by(0.4e-3));
  PrintOptions options;
  options.gap_control = GapControl::off;
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), options);
  ASSERT_TRUE(result.completed) << result.stop_reason;
  EXPECT_TRUE(result.approaches.empty());
  EXPECT_TRUE(result.offsets.empty());
  bool seen = false;
  for (const auto& s : rig.port().history()) {
    if (s.line != 6) continue;
    seen = true;
    ASSERT_NEAR(rig.commanded(s.position).translation().z(), kTable + kGap, 1e-9);
  }
  EXPECT_TRUE(seen);
}

TEST(Print, CountsWhatItDid) {
  GapRig rig(hexapod(), low_by(0));
  PrintOptions options;
  options.gap_control = GapControl::off;
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), options);
  ASSERT_TRUE(result.completed);
  EXPECT_EQ(result.moves, 6);
  EXPECT_NEAR(result.extruded, 2e-4, 1e-12);
  // Home is the table's point under S: up 5.13 mm, down 3, down 2, and 5 up at the end.
  EXPECT_NEAR(result.travel, (5.13 + 3 + 2 + 5) * 1e-3, 1e-9);
  EXPECT_GT(result.duration, 3);  // 2 s of bead, 1 s of approach at 2 mm/s, and travel
  EXPECT_NEAR(result.duration, rig.port().now(), 1e-12);
  // Filament: two beads of 0.1 mm fed, 1 mm retracted, absolute from the start.
  EXPECT_NEAR(rig.port().history().back().filament, 2e-4 - 1e-3, 1e-12);
  EXPECT_NEAR(rig.port().outputs().nozzle_temperature, 483, 1e-12);
  EXPECT_NEAR(rig.port().outputs().fan, 0.5, 1e-12);
}

TEST(Print, FilamentCountsOnWhereTheMotionPauses) {
  Program program = bead_program();
  Step fan;
  fan.kind = StepKind::fan;
  fan.fan = 1;
  fan.line = 6;
  program.steps.insert(program.steps.begin() + 6, fan);  // between the two beads: the tool comes to rest
  GapRig rig(hexapod(), low_by(0));
  PrintOptions options;
  options.gap_control = GapControl::off;
  ASSERT_TRUE(print(program, hexapod(), rig.port(), options).completed);
  double last = 0;
  for (const auto& s : rig.port().history()) {
    if (s.line > 7) break;
    ASSERT_GE(s.filament, last - 1e-15) << "line " << s.line;
    last = s.filament;
  }
  EXPECT_NEAR(last, 2e-4, 1e-12);
}

TEST(Print, MeasuresItsTimeFromItsOwnBeginning) {
  GapRig early(hexapod(), low_by(0)), late(hexapod(), low_by(0));
  ASSERT_EQ(late.port().wait_until(100), Status::ok);
  const double a = print(bead_program(), hexapod(), early.port(), {}).duration;
  const double b = print(bead_program(), hexapod(), late.port(), {}).duration;
  EXPECT_NEAR(a, b, 1e-3);  // a cycle
}

TEST(Print, ReportsProgressToItsEnd) {
  class Count : public PrintObserver {
   public:
    void progress(std::size_t done, std::size_t all, double) override {
      EXPECT_GT(done, last);
      last = done;
      total = all;
    }
    std::size_t last = 0, total = 0;
  } count;
  GapRig rig(hexapod(), low_by(0));
  ASSERT_TRUE(print(bead_program(), hexapod(), rig.port(), {}, &count).completed);
  EXPECT_EQ(count.last, 8u);  // all but M30
  EXPECT_EQ(count.total, 9u);
}

TEST(Print, NothingIsPrintedWithoutAKnownGap) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_mischief([](const Pose&, Image& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop_line, 5);
  EXPECT_THAT(result.stop_reason, AllOf(HasSubstr("no dot"), HasSubstr("retreated by 2.000 mm")));
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
  EXPECT_EQ(result.status, Status::faulted);
  EXPECT_EQ(result.fault, Fault::emergency_stop);
  EXPECT_THAT(result.stop_reason, HasSubstr("emergency stop"));
  EXPECT_GT(result.stop_line, 0);
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
    EXPECT_EQ(result.fault, Fault::emergency_stop);
    EXPECT_NEAR(result.duration, at, 1e-9);
    EXPECT_NEAR(rig.commanded_now().translation().z(), kTable + kGap, 1e-3);
  }
}

TEST(Print, AFaultThatStandsAlreadyIsNotIgnored) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(Fault::drive);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.fault, Fault::drive);
  EXPECT_THAT(result.stop_reason, HasSubstr("drive fault"));
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
              kinematics::Solve::ok);
    return o;
  }
};

PrintOptions without_gap_control() {
  PrintOptions options;
  options.gap_control = GapControl::off;
  return options;
}

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
  EXPECT_EQ(result.status, Status::deadline_exceeded);
  EXPECT_THAT(result.stop_reason, HasSubstr("deadline exceeded"));
  EXPECT_LT(port.now(), 60);
}

TEST(Print, ARejectedBatchStopsTheMachine) {
  WrongPort port;
  port.reject_after = 5;
  const PrintResult result = print(bead_program(), hexapod(), port, without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.status, Status::rejected);
  EXPECT_FALSE(port.state().moving) << "the rest of the queue still runs";
  EXPECT_EQ(port.outputs().nozzle_temperature, 0);
}

TEST(Print, AQueueThatRunsDryIsReported) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(Fault::underrun, 2.5);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_THAT(result.stop_reason, HasSubstr("queue underrun"));
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
  EXPECT_FALSE(rig.port().state().moving);
  EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0);
}

TEST(Print, AnInterruptIsHeardDuringTheApproach) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_mischief([](const Pose&, Image&) {
    set_interrupted(true);
    return true;
  });
  EXPECT_THROW(print(bead_program(), hexapod(), rig.port(), {}), Interrupted);
  set_interrupted(false);
  EXPECT_FALSE(rig.port().state().moving);
}

TEST(Print, APoseOutOfReachStopsAtRestAndNamesTheStrut) {
  Program program = bead_program();
  program.steps[6] = step_to(StepKind::print, {0.2, 0, kTable + kGap}, 5e-3, 7, 1e-4);
  GapRig rig(hexapod(), low_by(0));
  const PrintResult result = print(program, hexapod(), rig.port(), without_gap_control());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop_line, 7);
  EXPECT_THAT(result.stop_reason, HasSubstr("strut"));
  EXPECT_EQ(rig.port().state().fault, Fault::none) << "the queue ran dry in motion";
  EXPECT_NEAR(rig.commanded_now().translation().x(), 5e-3, 1e-6) << "the last good step was not finished";
}

TEST(Print, BeginsWhereTheMachineStands) {
  // A machine left 8 mm above home by whoever drove it last.
  machine::LoopbackPort::Options options;
  const auto mechanism = hexapod().make_mechanism();
  Pose X_BT = hexapod().X_BT_home;
  X_BT.translation().z() += 8e-3;
  ASSERT_EQ(mechanism->inverse(X_BT, {}, std::span<double>(options.start.data(), 6)), kinematics::Solve::ok);
  machine::LoopbackPort port(options);
  ASSERT_TRUE(print(bead_program(), hexapod(), port, without_gap_control()).completed);
  const auto& first = port.history().front();
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(first.position[i], options.start[i], 1e-6)
        << "the first setpoint jumps";  // one cycle of ramp
}

TEST(Print, TheSameRunTwiceGivesTheSameSetpoints) {
  GapRig a(hexapod(), low_by(-0.3e-3)), b(hexapod(), low_by(-0.3e-3));
  ASSERT_TRUE(print(bead_program(), hexapod(), a.port(), {}).completed);
  ASSERT_TRUE(print(bead_program(), hexapod(), b.port(), {}).completed);
  ASSERT_EQ(a.port().history().size(), b.port().history().size());
  for (std::size_t i = 0; i < a.port().history().size(); ++i)
    ASSERT_EQ(a.port().history()[i].position, b.port().history()[i].position);
}

TEST(Print, ASecondApproachReplacesTheFirstOffset) {
  // A second bead on the same part where the machine errs by 0.3 mm more.
  Program program = bead_program();
  const double z = kTable + kGap;
  program.steps.pop_back();
  for (const Step& s : {step_to(StepKind::travel, {0, 10e-3, z + 5e-3}, 0, 11),
                        step_to(StepKind::travel, {0, 10e-3, z + 2e-3}, 0, 12),
                        step_to(StepKind::move, {0, 10e-3, z}, 2e-3, 13),
                        step_to(StepKind::print, {5e-3, 10e-3, z}, 5e-3, 14, 1e-4)})
    program.steps.push_back(s);
  GapRig rig(hexapod(), low_by(0.2e-3));
  rig.set_play(
      [](const Pose& X) -> Vec3 { return X.translation().y() > 5e-3 ? Vec3(0, 0, 0.3e-3) : Vec3(0, 0, 0); });
  const PrintResult result = print(program, hexapod(), rig.port(), {});
  ASSERT_TRUE(result.completed) << result.stop_reason;
  ASSERT_EQ(result.offsets.size(), 2u);
  EXPECT_NEAR(result.offsets[0].offset_W.z(), -0.2e-3, 30e-6);
  EXPECT_NEAR(result.offsets[1].offset_W.z(), -0.5e-3, 30e-6);
  for (const auto& s : rig.port().history()) {
    if (s.line != 14) continue;
    ASSERT_GT(rig.gap_at(rig.commanded(s.position)), 0.1e-3);
    ASSERT_LT(rig.gap_at(rig.commanded(s.position)), 0.2e-3);
  }
}

TEST(Approach, IsTheStraightWayDownToABead) {
  const Program program = bead_program();
  for (std::size_t i = 0; i < program.steps.size(); ++i)
    EXPECT_EQ(is_approach(program, i), i == 4) << "step " << i;
}

TEST(Approach, IsShortStraightUnturnedAndBeforeABead) {
  const double z = kTable + kGap;
  const auto changed = [](std::size_t index, auto change) {
    Program program = bead_program();
    change(program.steps[index]);
    return is_approach(program, 4);
  };
  EXPECT_TRUE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z + 9.9e-3; }));
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z + 10.1e-3; })) << "longer than 10 mm";
  EXPECT_TRUE(changed(3, [&](Step& s) { s.X_WT.translation().x() = 2e-3 * std::tan(from_deg(0.9)); }));
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().x() = 2e-3 * std::tan(from_deg(1.1)); }))
      << "askew";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.linear() = exp_rotation(Vec3(from_deg(2), 0, 0)); }))
      << "turning";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z - 2e-3; })) << "upwards";
  EXPECT_FALSE(changed(3, [&](Step& s) { s.X_WT.translation().z() = z; })) << "no way at all";
  EXPECT_FALSE(changed(4, [&](Step& s) { s.kind = StepKind::travel; })) << "a travel";
  EXPECT_FALSE(changed(5, [&](Step& s) { s.kind = StepKind::travel; })) << "no bead begins there";
}

}  // namespace
}  // namespace understudy::control

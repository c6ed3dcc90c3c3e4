#include "control/print.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using machine::Status;
using toolpath::Program;
using toolpath::Step;
using toolpath::StepKind;

TEST(Print, CarriesTheOffsetOfTheStartAlongThePath) {
  GapRig rig(hexapod(), low_by(0.4e-3));
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), {});
  ASSERT_TRUE(result.completed) << result.stop.why;
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
  ASSERT_TRUE(result.completed) << result.stop.why;
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

// The bead program retracts 1 mm at its end. Pushed back afterwards, with 0.1 mm of new filament.
TEST(Print, FilamentThatARetractionTookBackIsNotFedTwice) {
  GapRig rig(hexapod(), low_by(0));
  Program program = bead_program();
  program.steps.insert(program.steps.end() - 1,
                       step_to(StepKind::print, {11e-3, 0, kTable + 5.13e-3}, 5e-3, 9, 1.1e-3));
  const PrintResult result = print(program, hexapod(), rig.port(), without_gap_control());
  ASSERT_TRUE(result.completed) << result.stop.why;
  EXPECT_NEAR(result.extruded, 3e-4, 1e-12);
  EXPECT_NEAR(result.primed, 1e-3, 1e-12);
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
  EXPECT_NEAR(last, 2e-4, 1e-7);  // the bead's last cycle ends under the next line
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

TEST(Print, BeginsWhereTheMachineStands) {
  // A machine left 8 mm above home by whoever drove it last.
  machine::LoopbackPort::Options options;
  const auto mechanism = hexapod().make_mechanism();
  Pose X_BT = hexapod().X_BT_home;
  X_BT.translation().z() += 8e-3;
  ASSERT_EQ(mechanism->inverse(X_BT, {}, std::span<double>(options.start.data(), 6)),
            kinematics::SolveStatus::ok);
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
  ASSERT_TRUE(result.completed) << result.stop.why;
  ASSERT_EQ(result.offsets.size(), 2u);
  EXPECT_NEAR(result.offsets[0].offset_W.z(), -0.2e-3, 30e-6);
  EXPECT_NEAR(result.offsets[1].offset_W.z(), -0.5e-3, 30e-6);
  for (const auto& s : rig.port().history()) {
    if (s.line != 14) continue;
    ASSERT_GT(rig.gap_at(rig.commanded(s.position)), 0.1e-3);
    ASSERT_LT(rig.gap_at(rig.commanded(s.position)), 0.2e-3);
  }
}

}  // namespace
}  // namespace understudy::control

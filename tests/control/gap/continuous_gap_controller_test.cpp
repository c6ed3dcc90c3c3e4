// Prints whose gap is followed: the whole chain of port, picture, dot, reading, follower and setpoints, on a
// machine whose error changes along the path.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "core/quantile.h"
#include "core/units.h"
#include "tests/control/gap/bead_program.h"

namespace understudy::control {
namespace {

using machine::Status;
using testing::AllOf;
using testing::HasSubstr;
using toolpath::Program;

PrintOptions continuous() {
  PrintOptions options;
  options.gap_control = GapControl::continuous;
  return options;
}

/// A machine whose tip sinks (positive: rises) by `slope` over the bead.
void set_slope(GapRig& rig, double slope) {
  rig.set_play(
      [slope](const Pose& X) -> Vec3 { return slope * std::max(0.0, X.translation().x()) * Vec3::UnitZ(); });
}

struct Beads {
  double in_band = 0;  ///< share of the cycles
  double gap_min = 1, gap_max = 0, rms = 0;
  int cycles = 0;
};

bool of_bead(const machine::Setpoint& s) { return s.line == 6 || s.line == 7; }

/// Without the last `but_for` [s] of the beads' setpoints.
Beads beads_of(const GapRig& rig, machine::LoopbackPort& port, double but_for = 0) {
  Beads beads;
  double squares = 0, end = 0;
  int inside = 0;
  for (const auto& s : port.history())
    if (of_bead(s)) end = s.time;
  for (const auto& s : port.history()) {
    if (!of_bead(s) || s.time > end - but_for) continue;
    const double gap = rig.gap_at(rig.commanded(s.position));
    ++beads.cycles;
    inside += gap > 0.1e-3 && gap < 0.2e-3 ? 1 : 0;
    beads.gap_min = std::min(beads.gap_min, gap);
    beads.gap_max = std::max(beads.gap_max, gap);
    squares += std::pow(gap - 0.13e-3, 2);
  }
  beads.in_band = static_cast<double>(inside) / beads.cycles;
  beads.rms = std::sqrt(squares / beads.cycles);
  return beads;
}

TEST(ContinuousPrint, KeepsTheGapWhereTheStartAloneLosesIt) {
  for (double slope : {-0.02, 0.02}) {  // 0.2 mm over 10 mm of bead
    GapRig start_rig(hexapod(), low_by(0.2e-3)), rig(hexapod(), low_by(0.2e-3));
    set_slope(start_rig, slope);
    set_slope(rig, slope);
    ASSERT_TRUE(print(bead_program(), hexapod(), start_rig.port(), {}).completed);
    const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
    ASSERT_TRUE(result.completed) << result.stop.why;
    EXPECT_LT(beads_of(start_rig, start_rig.port()).in_band, 0.6);
    const Beads beads = beads_of(rig, rig.port());
    EXPECT_EQ(beads.in_band, 1) << beads.gap_min << " to " << beads.gap_max;
    // 0.35 px of jitter are 5 um a frame, and the start may be 8 um off besides: 10 um. To see whether
    // readings follow it, the tool rises by 23 um: 23 sqrt(3/8) = 14 um while it does, here for two fifths of
    // the bead.
    EXPECT_LT(beads.rms, std::hypot(10e-6, 9e-6));
    ASSERT_TRUE(result.following);
    // 2 s of bead, a frame in 25 ms of it and the wait for the next cycle.
    EXPECT_NEAR(result.following->frames, 77, 6);
    EXPECT_GT(result.following->used, result.following->frames - 4);
    EXPECT_EQ(result.stop.gap, GapStop::none);
  }
}

TEST(ContinuousPrint, PositionsAndVelocitiesOfItsSetpointsAgree) {
  GapRig rig(hexapod(), low_by(0));
  set_slope(rig, 0.03);
  ASSERT_TRUE(print(bead_program(), hexapod(), rig.port(), continuous()).completed);
  const auto& history = rig.port().history();
  const MotionLimits limits = motion_limits(hexapod());
  for (std::size_t k = 1; k < history.size(); ++k) {
    const auto &a = history[k - 1], &b = history[k];
    const double dt = b.time - a.time;
    if (dt > 1.5e-3) continue;  // the tool rested in between
    for (std::size_t i = 0; i < 6; ++i) {
      // The trapezoidal rule errs by dt^3/12 of the jerk; a switch of acceleration by dt^2/8 of it.
      const double step = b.position[i] - a.position[i], rule = 0.5 * dt * (a.velocity[i] + b.velocity[i]);
      ASSERT_NEAR(step, rule, 0.25 * limits.axis_acceleration[i] * dt * dt + 1e-12) << b.line;
      if (b.line == 6 && k > 1 && history[k - 2].line == 6) {
        ASSERT_NEAR(step, rule, 50e-9) << "strut " << i;
      }
      ASSERT_LE(std::abs(b.velocity[i]), limits.axis_velocity[i]);
      ASSERT_LE(std::abs(b.velocity[i] - a.velocity[i]), limits.axis_acceleration[i] * dt * (1 + 1e-6));
    }
  }
}

TEST(ContinuousPrint, TellsItsOffsetsSoThatTheProgramCanBeFoundAgain) {
  class Keep : public PrintObserver {
   public:
    void progress(std::size_t, std::size_t, double) override {}
    void offset_changed(const OffsetChange& change) override { changes.push_back(change); }
    std::vector<OffsetChange> changes;
  } keep;
  GapRig rig(hexapod(), low_by(0.1e-3));
  set_slope(rig, 0.02);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous(), &keep);
  ASSERT_TRUE(result.completed) << result.stop.why;
  ASSERT_EQ(keep.changes.size(), result.offsets.size());
  ASSERT_GT(keep.changes.size(), 50u);
  EXPECT_LT(keep.changes.size(), 300u);
  EXPECT_FALSE(keep.changes.front().gradual);
  std::size_t next = 0;
  for (const auto& s : rig.port().history()) {
    if (s.line != 6 && s.line != 7) continue;
    while (next + 1 < keep.changes.size() && keep.changes[next + 1].time <= s.time) ++next;
    Vec3 offset = keep.changes[next].offset_W;
    if (next + 1 < keep.changes.size()) {
      const auto &a = keep.changes[next], &b = keep.changes[next + 1];
      ASSERT_TRUE(b.gradual);
      offset += (s.time - a.time) / (b.time - a.time) * (b.offset_W - a.offset_W);
    }
    // A hundredth of a second at 20 mm/s^2 bends by 0.25 um from the straight line, and 0.2 um are not told.
    ASSERT_NEAR(rig.commanded(s.position).translation().z() - offset.z(), kTable + kGap, 0.6e-6)
        << "at " << s.time;
  }
}

TEST(ContinuousPrint, ABeadUnderTheDotIsNotChased) {
  GapRig rig(hexapod(), low_by(0));
  // Between 4 and 4.6 mm the dot lies on a bead of 0.15 mm.
  rig.set_frame_fault([&](const Pose& X, Image& image) {
    const double x = X.translation().x();
    if (x < 4e-3 || x > 4.6e-3) return true;
    Pose over_bead = rig.truth(X);
    over_bead.translation().z() -= 0.15e-3;
    rig.draw_spot(*exact_dot(hexapod(), flat_part(), over_bead), 190, image);
    return true;
  });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  ASSERT_TRUE(result.completed) << result.stop.why;
  const Beads beads = beads_of(rig, rig.port());
  EXPECT_EQ(beads.in_band, 1) << beads.gap_min << " to " << beads.gap_max;
  EXPECT_GE(result.following->frames - result.following->used, 4);  // 0.6 mm take 0.12 s: five frames
}

TEST(ContinuousPrint, AHalfHiddenDotIsNotFollowed) {
  for (const double slope : {0.0, 0.02, -0.02}) {
    GapRig rig(hexapod(), low_by(0));
    set_slope(rig, slope);
    std::optional<Vec2> edge;  // stands still in the picture
    rig.set_frame_fault([&](const Pose& X, Image& image) {
      if (X.translation().x() < 3e-3) return true;
      if (!edge) edge = exact_dot(hexapod(), flat_part(), rig.truth(X));
      hide_beyond(*edge, Vec2(1, 0), image);
      return true;
    });
    const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
    EXPECT_FALSE(result.completed);
    ASSERT_TRUE(result.following);
    EXPECT_STREQ(to_string(result.stop.gap), "dot partly hidden");
    EXPECT_THAT(result.stop.why, HasSubstr("something hides a part of it"));
    // Without a reading for 0.5 s, 2.5 mm at 5 mm/s, of which the correction goes on along its line for 1 mm;
    // then the stop brakes along the path: half of kBrakingTime of setpoints, 0.25 mm. Over the rest the gap
    // changes by the slope, from an aim that is known to 3 sigma of a frame, 5 um, and above which the tool
    // may have risen.
    const double unseen = 0.5 * 5e-3 - 1e-3, braked = 5e-3 * 0.5 * machine::kBrakingTime;
    const double change = (unseen + braked) * std::abs(slope) + 3 * 5e-6;
    const Beads all = beads_of(rig, rig.port());
    EXPECT_GE(all.gap_min, 0.13e-3 - change) << "slope " << slope;
    EXPECT_LE(all.gap_max, 0.13e-3 + change + 46.7e-6) << "slope " << slope;
  }
}

TEST(ContinuousPrint, AVanishedDotStopsRetreatsAndSaysWhy) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_frame_fault([&](const Pose& X, Image& image) {
    if (X.translation().x() > 3e-3) std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  EXPECT_FALSE(result.completed);
  ASSERT_TRUE(result.following);
  EXPECT_STREQ(to_string(result.stop.gap), "no dot");
  EXPECT_THAT(result.stop.why,
              AllOf(HasSubstr("no dot: "), HasSubstr("frames in 0.5"), HasSubstr("; retreated by 2.000 mm")));
  EXPECT_EQ(result.stop.why.find('\n'), std::string::npos);
  EXPECT_EQ(result.stop.line, 7);  // 3 mm and half a second at 5 mm/s
  EXPECT_NEAR(rig.gap_now(), 2.13e-3, 30e-6);
  EXPECT_GT(beads_of(rig, rig.port()).gap_min, 0.1e-3);
  EXPECT_EQ(rig.port().outputs().nozzle_temperature, 0);
}

TEST(ContinuousPrint, AMachineThatSinksFasterThanItFollowsStopsBeforeItTouches) {
  GapRig rig(hexapod(), low_by(0));
  set_slope(rig, -0.03);
  PrintOptions options = continuous();
  options.following = gap_follower_options(hexapod());
  options.following->rate_max = 0.03e-3;
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), options);
  EXPECT_FALSE(result.completed);
  EXPECT_STREQ(to_string(result.stop.gap), "too close");
  EXPECT_GT(beads_of(rig, rig.port()).gap_min, 0.02e-3);
}

TEST(ContinuousPrint, ADeadCameraIsSaidToBeDead) {
  GapRig rig(hexapod(), low_by(0));
  rig.set_frame_fault([](const Pose& X, Image&) { return X.translation().x() < 2e-3; });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  EXPECT_FALSE(result.completed);
  EXPECT_THAT(result.stop.why, AllOf(HasSubstr("no picture from the microscope"), HasSubstr("retreated")));
}

TEST(ContinuousPrint, RepeatedFramesAreNotFollowed) {
  GapRig rig(hexapod(), low_by(0));
  set_slope(rig, 0.02);
  rig.set_frame_fault([&](const Pose& X, Image&) {
    if (X.translation().x() > 3e-3) rig.port().repeat_frames(kForGood);
    return true;
  });
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  EXPECT_FALSE(result.completed);
  EXPECT_STREQ(to_string(result.stop.gap), "stale frame");
  EXPECT_GT(beads_of(rig, rig.port()).gap_min, 0.1e-3);
}

TEST(ContinuousPrint, AFaultOfTheMachineIsAFaultOfTheMachine) {
  GapRig rig(hexapod(), low_by(0));
  rig.port().inject_fault(machine::Fault::following_error, 4.2);
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.stop.status, Status::faulted);
  EXPECT_EQ(result.stop.fault, machine::Fault::following_error);
}

TEST(ContinuousPrint, WithoutAnApproachItBeginsWhenReadingsAgree) {
  Program program = bead_program();
  program.steps.erase(program.steps.begin() +
                      3);  // straight from 5 mm up to S by a travel that is no approach
  program.steps[3] = step_to(toolpath::StepKind::travel, {0, 0, kTable + kGap}, 0, 5);
  GapRig rig(hexapod(), low_by(50e-6));
  const PrintResult result = print(program, hexapod(), rig.port(), continuous());
  ASSERT_TRUE(result.completed) << result.stop.why;
  EXPECT_TRUE(result.approaches.empty());
  std::vector<double> late;
  for (const auto& s : rig.port().history())
    if (s.line == 7) late.push_back(rig.gap_at(rig.commanded(s.position)) - 0.13e-3);
  // For up to two fifths of the bead the tool is lifted, to see whether the readings follow it: the median of
  // the rest.
  EXPECT_NEAR(quantile(late, 0.3), 0, 4e-6);
}

TEST(ContinuousPrint, TheSameRunTwiceGivesTheSameSetpoints) {
  GapRig a(hexapod(), low_by(-0.3e-3)), b(hexapod(), low_by(-0.3e-3));
  ASSERT_TRUE(print(bead_program(), hexapod(), a.port(), continuous()).completed);
  ASSERT_TRUE(print(bead_program(), hexapod(), b.port(), continuous()).completed);
  ASSERT_EQ(a.port().history().size(), b.port().history().size());
  for (std::size_t i = 0; i < a.port().history().size(); ++i)
    ASSERT_EQ(a.port().history()[i].position, b.port().history()[i].position);
}

TEST(ContinuousPrint, ASecondApproachTakesOverWhatWasCorrected) {
  Program program = bead_program();
  const double z = kTable + kGap;
  program.steps.pop_back();
  program.steps.push_back(step_to(toolpath::StepKind::travel, {10e-3, 0, z + 2e-3}, 0, 9));
  program.steps.push_back(step_to(toolpath::StepKind::move, {10e-3, 0, z}, 2e-3, 10));
  program.steps.push_back(step_to(toolpath::StepKind::print, {15e-3, 0, z}, 5e-3, 11, 1e-4));
  GapRig rig(hexapod(), low_by(0.1e-3));
  set_slope(rig, 0.02);
  const PrintResult result = print(program, hexapod(), rig.port(), continuous());
  ASSERT_TRUE(result.completed) << result.stop.why;
  ASSERT_EQ(result.approaches.size(), 2u);
  // 0.1 mm high at first and 0.2 mm more at 10 mm: what was followed is not to be found again.
  EXPECT_NEAR(result.approaches[1].outcome.offset_W.z(), 0, 40e-6);
  for (const auto& s : rig.port().history())
    if (s.line == 11) {
      // The tool rises by 23.3 um besides, to see whether the readings follow it.
      const double gap = rig.gap_at(rig.commanded(s.position));
      ASSERT_GT(gap, 0.13e-3 - 30e-6);
      ASSERT_LT(gap, 0.13e-3 + 30e-6 + 23.3e-6);
    }
}

TEST(ContinuousPrint, KeepsFewPicturesAndAllReadings) {
  GapRig rig(hexapod(), low_by(0));
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), continuous());
  ASSERT_TRUE(result.completed);
  int pictures = 0;
  for (const auto& look : result.following->samples) pictures += look.frame.image.pixels.empty() ? 0 : 1;
  EXPECT_EQ(static_cast<int>(result.following->samples.size()), result.following->frames);
  EXPECT_LE(pictures, 40);
  EXPECT_GE(pictures, 20);
}

}  // namespace
}  // namespace understudy::control

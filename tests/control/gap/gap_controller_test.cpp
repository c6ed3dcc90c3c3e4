#include "control/gap/gap_controller.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "tests/control/gap/gap_stage.h"

namespace understudy::control {
namespace {

void approach_from_everywhere(int first, int machines) {
  Random random(11, "approaches");
  for (int i = 0; i < machines; ++i) {
    const double degrees = random.uniform(-20, 20);
    const Start start = i % 2 ? on_bottle(degrees) : on_slope(degrees);
    // Errors of a manufactured machine: millimetres along the axis, half of one sideways, milliradians.
    const double error = random.uniform(-1.5e-3, 1.5e-3);
    const Vec3 sideways = 0.2e-3 * Vec3(random.normal(), random.normal(), 0);
    // On a slope a sideways error is a gap error too; it must leave room for S'.
    const Vec3 turn = 2e-3 * normal_vec3(random);
    if (i < first) continue;
    Stage stage(start, error, i % 2 ? sideways : Vec3::Zero(), turn, static_cast<std::uint64_t>(i));
    const GapOutcome outcome = stage.run();
    ASSERT_EQ(outcome.stop, GapStop::none) << "draw " << i << ": " << outcome.why;
    const double gap = stage.rig().gap_now();
    EXPECT_GT(gap, 0.1e-3) << "draw " << i;
    EXPECT_LT(gap, 0.2e-3) << "draw " << i;
    const auto way = stage.way();
    EXPECT_GT(way.gap_min, 0.05e-3) << "draw " << i;
    EXPECT_LT(way.climb_max, 1e-7) << "draw " << i << ": the tool moved back up";
    // What is to be carried is where the tool was commanded to, relative to S.
    EXPECT_LT(
        (stage.rig().commanded_now().translation() - start.X_WT_S.translation() - outcome.offset_W).norm(),
        1e-9);
  }
}

TEST(GapController, EveryApproachEndsInTheBandWithoutTouching) { approach_from_everywhere(0, 60); }
/// Of 500 the one whose first three steps read 0.124, 0.079 and 0.062 mm for 0.1, 0.1 and 0.05 mm: speckle.
TEST(GapController, AnUnluckyFirstStepDoesNotEndTheApproach) { approach_from_everywhere(313, 314); }
TEST(SlowGapController, EachOfFiveHundredApproachesEndsInTheBandWithoutTouching) {
  approach_from_everywhere(0, 500);
}

TEST(GapController, ReportsTheGapThatIsThere) {
  double squares = 0;
  constexpr int kRuns = 40;
  for (int i = 0; i < kRuns; ++i) {
    Stage stage(on_slope(0), 0.4e-3, Vec3::Zero(), Vec3::Zero(), static_cast<std::uint64_t>(100 + i));
    const GapOutcome outcome = stage.run();
    ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
    squares += std::pow(outcome.gap - stage.rig().gap_now(), 2);
    EXPECT_LT(outcome.sigma, 10e-6);  // the goal of docs/reference.md#dot-and-gap for one frame
  }
  // Jitter of 0.35 px at 14.2 um/px is 5.0 um a look and 2.9 um over three; 40 runs know that to 11 %.
  const double expected = 0.35 * 14.2e-6 / std::sqrt(3);
  EXPECT_NEAR(std::sqrt(squares / kRuns), expected, 0.45 * expected);
}

TEST(GapController, AveragesItsLastLooksAtDifferentHeights) {
  Stage stage(on_bottle(-20), 0.3e-3);
  const GapOutcome outcome = stage.run();
  ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
  const auto& looks = outcome.samples;
  ASSERT_GE(looks.size(), 4u);
  for (std::size_t i = looks.size() - 3; i < looks.size(); ++i) {
    EXPECT_TRUE(looks[i].used);
    EXPECT_LT(looks[i].reading.gap, 0.13e-3 + 0.15e-3 + 20e-6);
  }
  EXPECT_LT(looks.size(), 15u);  // ten looks are a second and a half of a print
}

TEST(GapController, AveragesAlsoWhenOneStepWouldDo) {
  GapControllerOptions options;
  options.step_fraction = 1;  // the second look is at the aim already
  Stage stage(on_slope(0));
  const GapOutcome outcome = stage.run(options);
  ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
  EXPECT_GE(outcome.samples.size(), 4u);  // one from afar, three averaged
}

TEST(GapController, AimsWhereItIsTold) {
  GapControllerOptions options;
  options.aim = 0.17e-3;
  Stage stage(on_slope(10), -0.4e-3);
  const GapOutcome outcome = stage.run(options);
  ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
  EXPECT_NEAR(stage.rig().gap_now(), 0.17e-3, 20e-6);  // tolerance 8 um, and 4 sigma of the average
  options.aim = 0.3e-3;
  EXPECT_THROW(stage.run(options), InputError);
}

// All play of a strut released at once, anywhere on the way down, in both directions.
void give_way_everywhere(double apart) {
  for (double jump : {-0.1e-3, 0.1e-3})
    for (double at = 1.8e-3; at > 0.02e-3; at -= apart) {
      Stage stage(on_slope(0));
      stage.rig().set_play([&](const Pose& X) -> Vec3 {
        return stage.height(X) < at ? Vec3(jump * Vec3::UnitZ()) : Vec3(Vec3::Zero());
      });
      const GapOutcome outcome = stage.run();
      EXPECT_GT(stage.way().gap_min, 0) << "touched after a jump of " << jump << " at " << at;
      if (outcome.stop != GapStop::none) continue;
      EXPECT_GT(stage.rig().gap_now(), 0.1e-3) << "jump of " << jump << " at " << at;
      EXPECT_LT(stage.rig().gap_now(), 0.2e-3) << "jump of " << jump << " at " << at;
    }
}

TEST(GapController, AMechanismThatGivesWayIsCaughtBeforeItTouches) { give_way_everywhere(0.2e-3); }
TEST(SlowGapController, AMechanismThatGivesWayAnywhereIsCaughtBeforeItTouches) {
  give_way_everywhere(0.01e-3);
}

TEST(GapController, TheSameSeedTakesTheSameWay) {
  Stage a(on_bottle(15), 0.7e-3), b(on_bottle(15), 0.7e-3);
  const GapOutcome first = a.run(), second = b.run();
  EXPECT_EQ(first.offset_W, second.offset_W);
  EXPECT_EQ(first.samples.size(), second.samples.size());
  EXPECT_EQ(first.gap, second.gap);
}

}  // namespace
}  // namespace understudy::control

#include "control/gap/gap_controller.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/control/gap/gap_stage.h"

namespace understudy::control {
namespace {

using testing::AllOf;
using testing::HasSubstr;

void expect_stopped_and_retreated(Stage& stage, const GapOutcome& outcome, GapStop reason,
                                  double lowest_gap = 0.05e-3) {
  EXPECT_STREQ(to_string(outcome.stop), to_string(reason)) << outcome.why;
  EXPECT_THAT(outcome.why, HasSubstr("; retreated by 2.000 mm"));
  EXPECT_EQ(outcome.why.find('\n'), std::string::npos);
  ASSERT_FALSE(stage.motion().targets.empty());
  double lowest = kStandoff;
  for (const Pose& X : stage.motion().targets) lowest = std::min(lowest, stage.height(X));
  EXPECT_GE(stage.height_now(), lowest + 2e-3 - 1e-9) << "the tool did not end above where it stopped";
  EXPECT_GT(stage.way().gap_min, lowest_gap);
}

TEST(GapController, WithoutADotItRetreats) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([](const Pose&, Image& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::no_dot);
  EXPECT_THAT(outcome.why, HasSubstr("no dot: "));
}

TEST(GapController, ADotThatVanishesOnTheWayStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose& X, Image& image) {
    if (stage.height(X) < 0.7e-3) std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::no_dot, 0.1e-3);
}

TEST(GapController, ASaturatedDotStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([](const Pose&, Image& image) {
    for (auto& p : image.pixels) p = p > 40 ? 255 : p;
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::saturated);
  EXPECT_THAT(outcome.why, HasSubstr("saturated"));
}

TEST(GapController, AnEdgeThatHidesAQuarterOfTheDotStopsItWhereverItStands) {
  // Beyond 0.67 standard deviations lies a quarter of a Gaussian; the dot's are at least 2.3 px.
  for (const double degrees : {0.0, 90.0, 200.0, 300.0}) {
    Stage stage(on_slope(10));
    const Vec2 side(std::cos(from_deg(degrees)), std::sin(from_deg(degrees)));
    stage.rig().set_frame_fault([&](const Pose& X, Image& image) {
      hide_beyond(*exact_dot(hexapod(), on_slope(10).world, stage.rig().truth(X)) + 1.5 * side, side, image);
      return true;
    });
    const GapOutcome outcome = stage.run();
    expect_stopped_and_retreated(stage, outcome, GapStop::partly_hidden);
    EXPECT_THAT(outcome.why, HasSubstr("something hides a part of it"));
  }
}

TEST(GapController, AFrameThatIsLostOrStaleNowAndThenIsAskedForAgain) {
  for (const bool lost : {true, false}) {
    Stage stage(on_slope(0));
    int frame = 0;
    stage.rig().set_frame_fault([&](const Pose&, Image&) {
      const bool now = ++frame % 3 == 0;
      stage.rig().port().repeat_frames(now && !lost ? 2 : 0);
      return !now || !lost;
    });
    const GapOutcome outcome = stage.run();
    EXPECT_EQ(outcome.stop, GapStop::none) << outcome.why;
    EXPECT_NEAR(stage.rig().gap_now(), 0.13e-3, 30e-6);
  }
}

TEST(GapController, ARepeatedFrameStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose& X, Image&) {
    if (stage.height(X) < 1.9e-3) stage.rig().port().repeat_frames(kForGood);
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::stale_frame);
  EXPECT_THAT(outcome.why, HasSubstr("was delivered twice"));
}

TEST(GapController, AFrameThatIsTooOldStopsIt) {
  Stage stage(on_slope(0));
  GapControllerOptions options;
  options.frame_age_max = 0.01;  // the rig's camera needs 12.5 ms
  const GapOutcome outcome = stage.run(options);
  expect_stopped_and_retreated(stage, outcome, GapStop::stale_frame);
  EXPECT_THAT(outcome.why, HasSubstr("0.013 s"));
}

TEST(GapController, APictureThatStandsStillStopsItWhereverItFreezes) {
  for (double at : {1.9e-3, 0.6e-3, 0.3e-3, 0.15e-3, 0.08e-3, 0.05e-3}) {
    Stage stage(on_slope(0));
    std::optional<Vec2> frozen;
    stage.rig().set_frame_fault([&](const Pose& X, Image& image) {
      if (stage.height(X) > at) return true;
      if (!frozen) frozen = exact_dot(hexapod(), on_slope(0).world, stage.rig().truth(X));
      stage.rig().draw_spot(*frozen, 190, image);
      return true;
    });
    const GapOutcome outcome = stage.run();
    EXPECT_GT(stage.way().gap_min, 0.02e-3) << "frozen at " << at;
    if (outcome.stop == GapStop::none) {
      EXPECT_GT(stage.rig().gap_now(), 0.05e-3) << "frozen at " << at;
    }
  }
}

TEST(GapController, ADotOffItsLineIsImplausible) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose& X, Image& image) {
    const Vec2 dot = *exact_dot(hexapod(), on_slope(0).world, stage.rig().truth(X));
    stage.rig().draw_spot(dot + Vec2(20, 20), 190, image);  // across the track, which runs left and down
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::implausible);
  EXPECT_THAT(outcome.why,
              AllOf(HasSubstr("px off the line on which it moves"), HasSubstr("at most 12.0 px")));
}

TEST(GapController, AReadingThatTheMotionDoesNotExplainIsImplausible) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose& X, Image& image) {
    if (stage.height(X) > 1.5e-3) return true;
    Pose elsewhere = stage.rig().truth(X);
    elsewhere.translation().z() += 1e-3;
    stage.rig().draw_spot(*exact_dot(hexapod(), on_slope(0).world, elsewhere), 190, image);
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::implausible, 0.1e-3);
  EXPECT_THAT(outcome.why, HasSubstr("where the motion leaves"));
}

TEST(GapController, APictureOfAnotherRegionIsImplausible) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([](const Pose&, Image& image) {
    image.region.x += 8;
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::implausible);
  EXPECT_THAT(outcome.why, HasSubstr("instead of 640 x 480 px at (0, 0)"));
}

TEST(GapController, ACameraThatDeliversNothingStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([](const Pose&, Image&) { return false; });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::port_failed);
  EXPECT_THAT(outcome.why, HasSubstr("no frame"));
}

TEST(GapController, AStartTooCloseIsTakenAgainFromAbove) {
  // The tip is 2.05 mm low: 0.08 mm are left at S'.
  Stage stage(on_slope(0), -2.05e-3);
  const GapOutcome outcome = stage.run();
  EXPECT_EQ(outcome.stop, GapStop::none) << outcome.why;
  EXPECT_GT(stage.rig().gap_now(), 0.1e-3);
  EXPECT_LT(stage.rig().gap_now(), 0.2e-3);
  ASSERT_FALSE(stage.motion().targets.empty());
  EXPECT_GT(stage.height(stage.motion().targets.front()), kStandoff) << "the first motion goes up";
  EXPECT_GT(stage.way().gap_min, 0.05e-3);
}

TEST(GapController, TooCloseTwiceGivesUp) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose&, Image& image) {
    Pose near = make_pose(Quat::Identity(), Vec3(0, 0, 0.05 + 0.06e-3));  // always 0.06 mm
    stage.rig().draw_spot(*exact_dot(hexapod(), on_slope(0).world, near), 190, image);
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::too_close);
  EXPECT_THAT(outcome.why, AllOf(HasSubstr("less than 0.100 mm"), HasSubstr("before, the gap reads 0.06")));
  for (const Pose& X : stage.motion().targets) EXPECT_GE(stage.height(X), kStandoff);
}

TEST(GapController, ASurfaceFarBelowTheProgrammedOneIsTooFar) {
  Stage stage(on_slope(0), 4.5e-3);
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::too_far);
  EXPECT_THAT(outcome.why, HasSubstr("lower than programmed, at most 4.000 mm are allowed"));
}

/// A tip that follows its commands with a play along the axis, and the dot where it is. It came from below.
class LoosePlay : public GapMotion {
 public:
  LoosePlay(Stage& stage, double play) : stage_(stage), play_(play), tip_(kStandoff) {
    stage.rig().set_frame_fault([this](const Pose& X_WT, Image& image) {
      Pose X_true = X_WT;
      X_true.translation() += (tip_ - stage_.height(X_WT)) * tool_axis(X_WT);
      stage_.rig().draw_spot(*exact_dot(hexapod(), on_slope(0).world, X_true), 190, image);
      return true;
    });
  }
  machine::Status move_to(const Pose& X_WT) override {
    const double commanded = stage_.height(X_WT);
    tip_ = std::clamp(tip_, commanded, commanded + play_);
    return stage_.motion().move_to(X_WT);
  }
  machine::MachinePort& port() override { return stage_.motion().port(); }
  double gap() const { return tip_ + kProgrammedGap; }

 private:
  Stage& stage_;
  double play_, tip_;  // [m], above S
};

// Twice 0.1 mm downwards move nothing: so does a ghost. 1 mm upwards, and down again, tells them apart.
TEST(GapController, PlayThatTakesUpTheFirstStepsIsNoGhost) {
  Stage stage(on_slope(0));
  LoosePlay loose(stage, 0.22e-3);
  const Start start = on_slope(0);
  const GapOutcome outcome = close_gap(hexapod(), start.surface, start.X_WT_S, kStandoff, loose, {});
  EXPECT_EQ(outcome.stop, GapStop::none) << outcome.why;
  EXPECT_GT(loose.gap(), 0.1e-3);
  EXPECT_LT(loose.gap(), 0.2e-3);
  const auto& targets = stage.motion().targets;
  const auto rises = std::count_if(targets.begin(), targets.end(),
                                   [&](const Pose& X) { return stage.height(X) > kStandoff + 0.5e-3; });
  EXPECT_EQ(rises, 2) << "up, and down a little, once";
}

TEST(GapController, ASpotThatStandsStillDoesNotFollowTheRiseEither) {
  Stage stage(on_slope(0));
  stage.rig().set_frame_fault([&](const Pose&, Image& image) {
    const Pose there = make_pose(Quat::Identity(), Vec3(0, 0, 0.05 + 2.1e-3));
    stage.rig().draw_spot(*exact_dot(hexapod(), on_slope(0).world, there), 190, image);
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::no_progress, 1.5e-3);
  EXPECT_THAT(outcome.why, HasSubstr("has not followed the tool as it rose and came down again"));
}

TEST(GapController, TooFewStopsAreNoProgress) {
  Stage stage(on_slope(0));
  GapControllerOptions options;
  options.stops_max = 3;
  const GapOutcome outcome = stage.run(options);
  expect_stopped_and_retreated(stage, outcome, GapStop::no_progress, 0.1e-3);
  EXPECT_THAT(outcome.why, HasSubstr("3 stops did not reach the gap of 0.130 mm"));
}

TEST(GapController, APortWithAFaultStopsItAndSaysThatItCouldNotRetreat) {
  Stage stage(on_slope(0));
  stage.rig().port().inject_fault(machine::Fault::emergency_stop, stage.rig().port().now() + 0.3);
  const GapOutcome outcome = stage.run();
  EXPECT_EQ(outcome.stop, GapStop::port_failed);
  EXPECT_THAT(outcome.why, AllOf(HasSubstr("emergency stop"), HasSubstr("could not retreat")));
  EXPECT_GT(stage.way().gap_min, 0.05e-3);
}

TEST(GapController, AMoveOutOfReachStopsItWithTheStrutsName) {
  class Wall : public GapMotion {
   public:
    explicit Wall(RigMotion& motion) : motion_(motion) {}
    machine::Status move_to(const Pose& X) override {
      if (X.translation().z() < 0.0512) throw InputError("strut 3 is 241.7 mm, longer than 240.0 mm");
      return motion_.move_to(X);
    }
    machine::MachinePort& port() override { return motion_.port(); }

   private:
    RigMotion& motion_;
  };
  Stage stage(on_slope(0));
  Wall wall(stage.motion());
  const Start start = on_slope(0);
  const GapOutcome outcome = close_gap(hexapod(), start.surface, start.X_WT_S, kStandoff, wall, {});
  expect_stopped_and_retreated(stage, outcome, GapStop::unreachable);
  EXPECT_THAT(outcome.why, HasSubstr("strut 3 is 241.7 mm"));
}

}  // namespace
}  // namespace understudy::control

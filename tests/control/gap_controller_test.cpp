#include "control/gap_controller.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/control/gap_rig.h"

namespace understudy::control {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kBottleRadius = 15.5e-3;   // [m]
constexpr double kProgrammedGap = 0.13e-3;  // [m], of S over the nominal part
constexpr double kStandoff = 2e-3;          // [m]

const machine::MachineDescription& hexapod() {
  static const auto machine = machine::load_machine("hexapod");
  return machine;
}

/// A start on a part: S and the part's surface below it as the controller believes them.
struct Start {
  Pose X_WT_S;
  LocalSurface surface;
  DotWorld world;
};

/// On a bottle along y whose crown is at the home tip, `degrees` around it, the tool on the normal.
Start on_bottle(double degrees) {
  const double a = from_deg(degrees);
  const Vec3 normal(std::sin(a), 0, std::cos(a)), axis_point(0, 0, 0.05 - kBottleRadius);
  Start start;
  start.world = cylinder_around(axis_point, Vec3::UnitY(), kBottleRadius);
  start.X_WT_S =
      make_pose(shortest_arc_from_z(normal), Vec3(axis_point + (kBottleRadius + kProgrammedGap) * normal));
  start.surface.curvature(0, 0) = -1 / kBottleRadius;
  return start;
}

/// On a plane through the home tip that leans away from the upright tool, towards the laser.
Start on_slope(double degrees) {
  Start start;
  const double a = from_deg(degrees);
  start.world = plane_through(Vec3(0, 0, 0.05), Vec3(0, -std::sin(a), std::cos(a)));
  start.X_WT_S = make_pose(Quat::Identity(), Vec3(0, 0, 0.05 + kProgrammedGap));
  start.surface.slope.y() = std::tan(a);
  return start;
}

/// A rig that stands at S' of a start, with a tip error of `gap_error` along the axis and `sideways` beside
/// it.
class Stage {
 public:
  explicit Stage(const Start& start, double gap_error = 0, const Vec3& sideways = Vec3::Zero(),
                 const Vec3& tool_error = Vec3::Zero(), std::uint64_t seed = 1)
      : start_(start),
        rig_(hexapod(),
             {start.world, gap_error * tool_axis(start.X_WT_S) + sideways, tool_error, 0.35, seed}),
        motion_(hexapod(), rig_) {
    Pose X = start.X_WT_S;
    X.translation() += kStandoff * tool_axis(X);
    EXPECT_EQ(motion_.move_to(X), machine::Status::ok);
    motion_.targets.clear();
    history_begin_ = rig_.port().history().size();
  }

  GapOutcome run(const GapControllerOptions& options = {}) {
    return close_gap(hexapod(), start_.surface, start_.X_WT_S, kStandoff, motion_, options);
  }
  GapRig& rig() { return rig_; }
  RigMotion& motion() { return motion_; }
  double height(const Pose& X) const {
    return (X.translation() - start_.X_WT_S.translation()).dot(tool_axis(start_.X_WT_S));
  }
  double height_now() const { return height(rig_.commanded_now()); }

  /// What the drives executed since the approach began: smallest true gap, largest step upwards.
  struct Way {
    double gap_min = 1, climb_max = 0;
  };
  Way way() const {
    Way way;
    double last = kStandoff;
    const auto& history = rig_.port().history();
    for (std::size_t i = history_begin_; i < history.size(); i += 10) {
      const Pose X = rig_.commanded(history[i].position);
      way.gap_min = std::min(way.gap_min, rig_.gap_at(X));
      way.climb_max = std::max(way.climb_max, height(X) - last);
      last = height(X);
    }
    way.gap_min = std::min(way.gap_min, rig_.gap_now());
    return way;
  }

 private:
  Start start_;
  mutable GapRig rig_;
  RigMotion motion_;
  std::size_t history_begin_ = 0;
};

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

void approach_from_everywhere(int machines) {
  Random random(11, "approaches");
  for (int i = 0; i < machines; ++i) {
    const double degrees = random.uniform(-20, 20);
    const Start start = i % 2 ? on_bottle(degrees) : on_slope(degrees);
    // Errors of a manufactured machine: millimetres along the axis, half of one sideways, milliradians.
    const double error = random.uniform(-1.5e-3, 1.5e-3);
    const Vec3 sideways = 0.2e-3 * Vec3(random.normal(), random.normal(), 0);
    // On a slope a sideways error is a gap error too; it must leave room for S'.
    const Vec3 turn = 2e-3 * Vec3(random.normal(), random.normal(), random.normal());
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

TEST(GapController, EveryApproachEndsInTheBandWithoutTouching) { approach_from_everywhere(60); }
TEST(SlowGapController, EachOfFiveHundredApproachesEndsInTheBandWithoutTouching) {
  approach_from_everywhere(500);
}

TEST(GapController, ReportsTheGapThatIsThere) {
  double squares = 0;
  constexpr int kRuns = 40;
  for (int i = 0; i < kRuns; ++i) {
    Stage stage(on_slope(0), 0.4e-3, Vec3::Zero(), Vec3::Zero(), static_cast<std::uint64_t>(100 + i));
    const GapOutcome outcome = stage.run();
    ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
    squares += std::pow(outcome.gap - stage.rig().gap_now(), 2);
    EXPECT_LT(outcome.sigma, 10e-6);  // the goal of reference D for one frame
  }
  // Jitter of 0.35 px at 14.2 um/px is 5.0 um a look and 2.9 um over three; 40 runs know that to 11 %.
  const double expected = 0.35 * 14.2e-6 / std::sqrt(3);
  EXPECT_NEAR(std::sqrt(squares / kRuns), expected, 0.45 * expected);
}

TEST(GapController, AveragesItsLastLooksAtDifferentHeights) {
  Stage stage(on_bottle(-20), 0.3e-3);
  const GapOutcome outcome = stage.run();
  ASSERT_EQ(outcome.stop, GapStop::none) << outcome.why;
  const auto& looks = outcome.looks;
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
  EXPECT_GE(outcome.looks.size(), 4u);  // one from afar, three averaged
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

TEST(GapController, WithoutADotItRetreats) {
  Stage stage(on_slope(0));
  stage.rig().set_mischief([](const Pose&, Image& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::no_dot);
  EXPECT_THAT(outcome.why, HasSubstr("no dot: "));
}

TEST(GapController, ADotThatVanishesOnTheWayStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_mischief([&](const Pose& X, Image& image) {
    if (stage.height(X) < 0.7e-3) std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::no_dot, 0.1e-3);
}

TEST(GapController, ASaturatedDotStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_mischief([](const Pose&, Image& image) {
    for (auto& p : image.pixels) p = p > 40 ? 255 : p;
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::saturated);
  EXPECT_THAT(outcome.why, HasSubstr("saturated"));
}

TEST(GapController, ARepeatedFrameStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_mischief([&](const Pose& X, Image&) {
    if (stage.height(X) < 1.9e-3) stage.rig().port().repeat_frames(true);
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
    stage.rig().set_mischief([&](const Pose& X, Image& image) {
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
  stage.rig().set_mischief([&](const Pose& X, Image& image) {
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
  stage.rig().set_mischief([&](const Pose& X, Image& image) {
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
  stage.rig().set_mischief([](const Pose&, Image& image) {
    image.region.x += 8;
    return true;
  });
  const GapOutcome outcome = stage.run();
  expect_stopped_and_retreated(stage, outcome, GapStop::implausible);
  EXPECT_THAT(outcome.why, HasSubstr("instead of 640 x 480 px at (0, 0)"));
}

TEST(GapController, ACameraThatDeliversNothingStopsIt) {
  Stage stage(on_slope(0));
  stage.rig().set_mischief([](const Pose&, Image&) { return false; });
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
  stage.rig().set_mischief([&](const Pose&, Image& image) {
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

TEST(GapController, TheSameSeedTakesTheSameWay) {
  Stage a(on_bottle(15), 0.7e-3), b(on_bottle(15), 0.7e-3);
  const GapOutcome first = a.run(), second = b.run();
  EXPECT_EQ(first.offset_W, second.offset_W);
  EXPECT_EQ(first.looks.size(), second.looks.size());
  EXPECT_EQ(first.gap, second.gap);
}

}  // namespace
}  // namespace understudy::control

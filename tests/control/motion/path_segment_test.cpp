#include "control/motion/path_segment.h"

#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

using toolpath::Step;
using toolpath::StepKind;

MotionLimits known_limits() {
  MotionLimits limits;
  limits.travel_velocity = 0.05;
  limits.orientation_velocity = 1;  // [rad/s]
  return limits;
}

Step step_to(const Pose& X_WT, StepKind kind = StepKind::print) {
  Step step;
  step.kind = kind;
  step.X_WT = X_WT;
  step.feed = 0.01;
  step.line = 12;
  return step;
}

PathSegment segment_of(const Step& step) {
  return make_segment(step, Pose::Identity(), std::nullopt, known_limits());
}

Pose moved(const Vec3& p, const Vec3& turn = Vec3::Zero()) { return make_pose(exp_rotation(turn), p); }

TEST(PathSegment, OfTravelHasItsLengthAndTheProgrammedSpeed) {
  Step step = step_to(moved({3e-3, 4e-3, 0}));
  step.filament = 2e-4;
  const PathSegment s = segment_of(step);
  EXPECT_NEAR(s.length, 5e-3, 1e-15);
  EXPECT_NEAR(s.speed, 0.01, 1e-15);
  EXPECT_NEAR(s.tip_slope().norm(), 1, 1e-12);
  EXPECT_NEAR((s.tip_at(2.5e-3) - Vec3(1.5e-3, 2e-3, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(s.tip_at(s.length), Vec3(3e-3, 4e-3, 0)) << "the programmed pose, to the last bit";
  EXPECT_NEAR(s.filament_at(0.25), 0.5e-4, 1e-18);
  EXPECT_EQ(s.filament_at(1), 2e-4);
  EXPECT_NEAR(segment_of(step_to(moved({3e-3, 4e-3, 0}), StepKind::travel)).speed, 0.05, 1e-15);
}

TEST(PathSegment, OfATurnCountsFiveMillimetresARadian) {
  const PathSegment s = segment_of(step_to(moved(Vec3::Zero(), {0, 0.1, 0})));
  EXPECT_NEAR(s.length, 0.5e-3, 1e-12);
  EXPECT_NEAR(s.speed, 5e-3, 1e-12) << "1 rad/s, for there is no way of the tip to time";
  EXPECT_NEAR(s.twist_W().tail<3>().y(), 200, 1e-6) << "rad per metre of s";
  EXPECT_EQ(s.twist_W().head<3>(), Vec3::Zero());
}

TEST(PathSegment, ATurnThatOutlastsTheTravelSlowsIt) {
  // 1 mm takes 0.1 s at 10 mm/s; half a radian takes 0.5 s at 1 rad/s, 2.5 mm of s.
  const PathSegment s = segment_of(step_to(moved({1e-3, 0, 0}, {0.5, 0, 0})));
  EXPECT_NEAR(s.length, 2.5e-3, 1e-12);
  EXPECT_NEAR(s.length / s.speed, 0.5, 1e-9);
  // The axis of the turn is told in T at the beginning: a tool that was turned before turns about W's x.
  const Pose begin = moved(Vec3::Zero(), {0, 0, 1});
  const Pose end = make_pose(Mat3(exp_rotation({0.2, 0, 0}) * begin.linear()), Vec3(1e-3, 0, 0));
  const PathSegment turned = make_segment(step_to(end), begin, std::nullopt, known_limits());
  EXPECT_NEAR((turned.twist_W().tail<3>().normalized() - Vec3::UnitX()).norm(), 0, 1e-9);
}

TEST(PathSegment, InverseTimeIsTheTimeOfTheWholeStep) {
  Step step = step_to(moved({4e-3, 0, 0}));
  step.duration = 2;
  EXPECT_NEAR(segment_of(step).speed, 2e-3, 1e-15);
}

TEST(PathSegment, RestsForADwellAndForFilamentFedOnTheSpot) {
  Step dwell;
  dwell.kind = StepKind::dwell;
  dwell.duration = 1.5;
  EXPECT_FALSE(segment_of(dwell).moves());
  EXPECT_EQ(segment_of(dwell).rest, 1.5);
  Step retract = step_to(Pose::Identity(), StepKind::move);
  retract.filament = -2e-3;
  EXPECT_FALSE(segment_of(retract).moves());
  EXPECT_NEAR(segment_of(retract).rest, 0.2, 1e-12);
  EXPECT_FALSE(segment_of(step_to(moved({0.9e-9, 0, 0}))).moves()) << "rounding of a pose is no way";
  EXPECT_TRUE(segment_of(step_to(moved({1.1e-9, 0, 0}))).moves());
}

TEST(PathSegment, TheTurningAxesRunLinearly) {
  const PathSegment::Rotary rotary{{0, 0.2}, {0.1, -0.2}};
  const PathSegment s =
      make_segment(step_to(moved({10e-3, 0, 0}, {0, 0.1, 0})), Pose::Identity(), rotary, known_limits());
  EXPECT_NEAR(s.turns_at(s.length / 4).b, 0.025, 1e-12);
  EXPECT_NEAR(s.turns_at(s.length / 4).c, 0.1, 1e-12);
  EXPECT_EQ(s.turns_at(s.length).c, -0.2);
  EXPECT_NEAR(s.turn, std::hypot(0.1, 0.4), 1e-12);
}

TEST(PathSegment, RefusesWithTheLineWhatCannotBeDriven) {
  const auto refusal = [](const std::function<void(Step&)>& spoil) -> std::string {
    Step step = step_to(moved({1e-3, 0, 0}));
    spoil(step);
    try {
      segment_of(step);
    } catch (const InputError& error) {
      EXPECT_EQ(error.place().line, 12);
      return error.what();
    }
    return "no error";
  };
  using testing::HasSubstr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal([](Step&) {}), "no error");
  EXPECT_THAT(refusal([](Step& s) { s.feed = 0; }), HasSubstr("feed is 0.000000 mm/s, must be above 0"));
  EXPECT_THAT(refusal([&](Step& s) { s.feed = nan; }), HasSubstr("feed is"));
  EXPECT_THAT(refusal([&](Step& s) { s.X_WT.translation().x() = nan; }), HasSubstr("the pose is not finite"));
  EXPECT_THAT(refusal([](Step& s) { s.X_WT.linear() *= 1.001; }), HasSubstr("is not a rotation"));
  EXPECT_THAT(refusal([](Step& s) { s.X_WT.linear().col(0) *= -1; }), HasSubstr("is not a rotation"));
  EXPECT_THAT(refusal([](Step& s) { s.duration = -1; }), HasSubstr("duration is -1"));
  EXPECT_THAT(refusal([&](Step& s) { s.filament = nan; }), HasSubstr("filament's length is not finite"));
}

TEST(PathSegment, PartsAreNoLongerThanAskedFor) {
  const PathSegment s = segment_of(step_to(moved({10e-3, 0, 0}, {0.1, 0, 0})));
  EXPECT_EQ(parts_of(s, 1, 1), 1);
  EXPECT_EQ(parts_of(s, 5e-3, 1), 2) << "rounding does not add a part";
  EXPECT_EQ(parts_of(s, 4.9e-3, 1), 3);
  EXPECT_EQ(parts_of(s, 1, 0.03), 4);
}

}  // namespace
}  // namespace understudy::control

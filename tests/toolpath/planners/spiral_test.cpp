#include "toolpath/planners/spiral.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

SpiralPlan plan() {
  SpiralPlan p;
  p.centre = Vec3(5e-3, -3e-3, 0);
  p.radius = 10e-3;
  p.pitch = 10e-3;
  p.turns = 2.5;
  p.gap = 0.13e-3;
  p.lean = 20 * kDegree;
  p.lean_turns = 1;
  p.strand_diameter = 0.45e-3;
  p.chord_tolerance = 5e-6;
  p.feed = 5e-3;
  p.approach_feed = 1e-3;
  p.clearance = 8e-3;
  p.end_dwell = 5;
  p.filament_diameter = 1.75e-3;
  p.temperature = 503.15;
  return p;
}

std::vector<Step> path_of(const Program& program) {
  std::vector<Step> path;
  for (const Step& s : program.steps)
    if (s.kind == StepKind::move || s.kind == StepKind::print) path.push_back(s);
  return path;
}

TEST(Spiral, ItsLengthIsThatOfTheHelixAndItsVolumeThatOfTheStrand) {
  const Program program = plan_spiral(plan());
  const double length = 2.5 * std::hypot(2 * kPi * 10e-3, 10e-3);
  EXPECT_NEAR(spiral_length(plan()), length, 1e-15);
  double chords = 0, fed = 0;
  const auto path = path_of(program);
  for (std::size_t i = 1; i < path.size(); ++i) {
    chords += (path[i].X_WT.translation() - path[i - 1].X_WT.translation()).norm();
    fed += path[i].filament;
  }
  EXPECT_LT(chords, length);
  // A chord with a sag of 5 um on 10 mm is shorter than its arc by (2 / 3) 5e-6 / 10e-3.
  EXPECT_GT(chords, length * (1 - 0.34e-3));
  EXPECT_NEAR(fed, length * std::pow(0.45 / 1.75, 2), 1e-12);
}

TEST(Spiral, EveryPointIsOnTheHelixAndChordsAreWithinTheTolerance) {
  const auto path = path_of(plan_spiral(plan()));
  EXPECT_NEAR(path.front().X_WT.translation().z(), 0.13e-3, 1e-15);
  EXPECT_NEAR(path.back().X_WT.translation().z(), 25.13e-3, 1e-12);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3 p = path[i].X_WT.translation() - plan().centre;
    EXPECT_NEAR(p.head<2>().norm(), 10e-3, 1e-12);
    const double phi = std::atan2(p.y(), p.x()), turns = (p.z() - 0.13e-3) / 10e-3;
    EXPECT_NEAR(std::remainder(2 * kPi * turns - phi, 2 * kPi), 0, 1e-9);
    const Vec3 middle = 0.5 * (path[i].X_WT.translation() + path[i - 1].X_WT.translation()) - plan().centre;
    EXPECT_GT(middle.head<2>().norm(), 10e-3 - 5.001e-6);
  }
}

TEST(Spiral, TheToolLeansAlongTheCurveByTheAngleAskedFor) {
  const auto path = path_of(plan_spiral(plan()));
  double last_lean = -1;
  for (const Step& s : path) {
    const Vec3 p = s.X_WT.translation() - plan().centre, axis = tool_axis(s.X_WT);
    const Vec3 forward = Vec3::UnitZ().cross(Vec3(p.x(), p.y(), 0)).normalized();
    const double lean = std::atan2(axis.dot(forward), axis.z());
    EXPECT_NEAR(axis.dot(Vec3(p.x(), p.y(), 0).normalized()), 0, 1e-12);
    EXPECT_GE(lean, last_lean - 1e-12);
    last_lean = lean;
    // Half of the lean after half of the turns that it takes, all of it after them.
    const double turns = (p.z() - 0.13e-3) / 10e-3;
    if (turns >= 1) {
      EXPECT_NEAR(lean, 20 * kDegree, 1e-12);
    }
  }
  const Pose half = spiral_pose(plan(), kPi);
  EXPECT_NEAR(std::acos(tool_axis(half).z()), 10 * kDegree, 1e-9);
  EXPECT_NEAR(tool_axis(path.front().X_WT).z(), 1, 1e-15);
}

TEST(Spiral, TheLeanEndsAtTheTangent) {
  SpiralPlan p = plan();
  p.pitch = 100e-3;  // rises at atan(100 / 62.8) = 57.9 deg: the tangent is 32.1 deg from vertical
  p.lean = 60 * kDegree;
  const double tangent = std::atan2(2 * kPi * 10, 100);
  EXPECT_NEAR(std::acos(tool_axis(spiral_pose(p, 4 * kPi)).z()), tangent, 1e-9);
}

TEST(Spiral, EveryValueIsChecked) {
  const auto rejection = [](const SpiralPlan& p) -> std::string {
    try {
      plan_spiral(p);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  ASSERT_EQ(rejection(plan()), "accepted");
  for (double SpiralPlan::*field :
       {&SpiralPlan::radius, &SpiralPlan::pitch, &SpiralPlan::gap, &SpiralPlan::strand_diameter,
        &SpiralPlan::feed, &SpiralPlan::approach_feed, &SpiralPlan::clearance,
        &SpiralPlan::filament_diameter})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      SpiralPlan p = plan();
      p.*field = bad;
      EXPECT_THAT(rejection(p), HasSubstr("must be above 0")) << bad;
    }
  for (const double bad : {0.0, 1e-15, 0.02, std::nan("")}) {
    SpiralPlan p = plan();
    p.chord_tolerance = bad;
    EXPECT_THAT(rejection(p), HasSubstr("outside 0.001 to 10 mm")) << bad;
  }
  SpiralPlan p = plan();
  p.lean = 70 * kDegree;
  EXPECT_THAT(rejection(p), HasSubstr("lean is 70 deg, outside 0 to 60 deg"));
  p = plan();
  p.turns = -1;
  EXPECT_THAT(rejection(p), HasSubstr("number of turns is -1"));
  p = plan();
  p.pitch = 0.5e-3;
  EXPECT_THAT(rejection(p), HasSubstr("pitch is 0.5 mm, less than two strands of 0.45 mm"));
  p = plan();
  p.fan = 2;
  EXPECT_THAT(rejection(p), HasSubstr("fan is 2"));
}

}  // namespace
}  // namespace understudy::toolpath

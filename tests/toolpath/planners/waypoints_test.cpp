#include "toolpath/planners/waypoints.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/complaint.h"
#include "toolpath/bead.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

WaypointPlan plan() {
  WaypointPlan p;
  p.bead_width = 0.5e-3;
  p.bead_height = 0.2e-3;
  p.feed = 5e-3;
  p.approach_feed = 1e-3;
  p.clearance = 4e-3;
  p.largest_step = 3e-3;
  p.tilt_max = 60 * kDegree;
  p.filament_diameter = 1.75e-3;
  p.temperature = 483.15;
  p.fan = 1;
  return p;
}

std::string rejection(const std::string& text) {
  return complaint([&] { parse_waypoints(text, "layer.txt"); });
}

// Points of a dome of 30 mm radius along a meridian, from -a to a degrees.
WaypointLayer meridian(double from_deg_, double to_deg_, double y, int count) {
  WaypointLayer layer;
  for (int i = 0; i < count; ++i) {
    const double a = (from_deg_ + (to_deg_ - from_deg_) * i / (count - 1)) * kDegree;
    const Vec3 normal(std::sin(a), 0, std::cos(a));
    layer.push_back({Vec3(0, y, 0) + 30e-3 * normal, normal});
  }
  return layer;
}

TEST(Waypoints, ReadsMillimetresAndMakesNormalsUnit) {
  const WaypointLayer layer =
      parse_waypoints("# a comment\n1 2 3 0 0 1\r\n\n\t-1.5e0 0 2.5 0.6 0 0.801\n", "f");
  ASSERT_EQ(layer.size(), 2u);
  EXPECT_LT((layer[0].position - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT((layer[1].position - Vec3(-1.5e-3, 0, 2.5e-3)).norm(), 1e-15);
  EXPECT_NEAR(layer[1].normal.norm(), 1, 1e-15);
  EXPECT_NEAR(layer[1].normal.x() / layer[1].normal.z(), 0.6 / 0.801, 1e-12);
}

TEST(Waypoints, EveryBadRowIsRefusedWithLineValueAndLimit) {
  const std::string good = "0 0 1 0 0 1\n1 0 1 0 0 1\n";
  ASSERT_EQ(rejection(good), "accepted");
  EXPECT_THAT(rejection(good + "0 0 1 0 0\n"),
              HasSubstr("layer.txt:3: 5 numbers in the row, a waypoint has 6"));
  EXPECT_THAT(rejection(good + "0 0 1 0 0 1 7\n"), HasSubstr("layer.txt:3: 7 numbers"));
  EXPECT_THAT(rejection(good + "0 0 x1 0 0 1\n"), HasSubstr("layer.txt:3:5: 'x1' is not a finite number"));
  EXPECT_THAT(rejection(good + "0 0 nan 0 0 1\n"), HasSubstr("'nan' is not a finite number"));
  EXPECT_THAT(rejection(good + "0 0 inf 0 0 1\n"), HasSubstr("'inf' is not a finite number"));
  EXPECT_THAT(rejection(good + "0 0 1e400 0 0 1\n"), HasSubstr("'1e400' is not a finite number"));
  EXPECT_THAT(rejection(good + "0 -100001 1 0 0 1\n"),
              HasSubstr("layer.txt:3:3: -100001 mm is beyond 100000 mm"));
  EXPECT_EQ(rejection(good + "0 -100000 1 0 0 1\n"), "accepted");
  EXPECT_THAT(rejection(good + "0 0 1 0 0 1.01\n"),
              HasSubstr("layer.txt:3: the normal's length is 1.010000, more than 0.002 from 1"));
  EXPECT_THAT(rejection(good + "0 0 1 0 0 0\n"), HasSubstr("the normal's length is 0.000000"));
  EXPECT_THAT(rejection("0 0 1 0 0 1\n"), HasSubstr("layer.txt: 1 waypoints, a layer needs 2"));
  EXPECT_THAT(rejection(""), HasSubstr("0 waypoints"));
  EXPECT_THROW(read_waypoints("/nonexistent.txt"), InputError);
}

TEST(Waypoints, TurningKeepsShapeAndPutsUpUp) {
  std::vector<WaypointLayer> layers = {
      {{Vec3(1e-3, 2e-3, 3e-3), Vec3(0, -1, 0)}, {Vec3(1e-3, 5e-3, 3e-3), Vec3(0, -1, 0)}}};
  turn(layers, {Vec3::UnitY(), true});
  EXPECT_LT((layers[0][0].normal - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((layers[0][1].position - layers[0][0].position - Vec3(0, 0, 3e-3)).norm(), 1e-15);
  place_on(layers, Vec3(10e-3, 20e-3, 1e-3));
  EXPECT_LT((layers[0][0].position - Vec3(10e-3, 20e-3, 1e-3)).norm(), 1e-15);
}

TEST(Waypoints, TheTipGoesThroughEveryPointWithTheToolOnItsNormalAndNoSpin) {
  const WaypointLayer layer = meridian(-20, 20, 0, 30);
  const WaypointProgram result = plan_waypoints({layer}, plan());
  EXPECT_EQ(result.strokes, 1);
  std::size_t i = 0;
  for (const Step& s : result.program.steps) {
    if (s.kind != StepKind::print && s.kind != StepKind::move) continue;
    EXPECT_LT((s.X_WT.translation() - layer[i].position).norm(), 1e-15);
    EXPECT_LT((tool_axis(s.X_WT) - layer[i].normal).norm(), 1e-12);
    // The shortest arc from vertical turns about a level axis.
    EXPECT_LT(std::abs(log_rotation(s.X_WT.linear()).z()), 1e-12);
    ++i;
  }
  EXPECT_EQ(i, layer.size());
}

TEST(Waypoints, FeedsTheVolumeOfTheBeadAndNothingAcrossAGap) {
  WaypointLayer layer = meridian(-20, -5, 0, 12);
  const WaypointLayer other = meridian(5, 20, 0, 12);
  layer.insert(layer.end(), other.begin(), other.end());
  const WaypointProgram result = plan_waypoints({layer}, plan());
  EXPECT_EQ(result.strokes, 2);
  // Two times eleven chords of an arc of 15 deg.
  const double length = 22 * 2 * 30e-3 * std::sin(15 * kDegree / 22);
  EXPECT_NEAR(result.printed, length, 1e-12);
  double fed = 0;
  for (const Step& s : result.program.steps) fed += s.filament;
  const double area = 0.3 * 0.2 + std::numbers::pi * 0.01;  // [mm^2], a stadium
  EXPECT_NEAR(fed, area * 1e-6 * length / (std::numbers::pi * 0.875e-3 * 0.875e-3), 1e-12);
}

TEST(Waypoints, TravelStaysAboveWhatIsPrinted) {
  // Three meridians side by side; then from the one end back to the other, over the crest.
  std::vector<WaypointLayer> layers = {meridian(-40, 40, 0, 60), meridian(-40, 40, 2e-3, 60)};
  const WaypointProgram result = plan_waypoints(layers, plan());
  EXPECT_EQ(result.strokes, 2);
  const auto& steps = result.program.steps;
  bool crossed = false;
  for (std::size_t i = 3; i < steps.size(); ++i) {
    if (steps[i].kind != StepKind::travel) continue;
    for (double t = 0; t <= 1; t += 0.05) {
      const Vec3 tip = interpolate(steps[i - 1].X_WT, steps[i].X_WT, t).translation();
      const double height = std::hypot(tip.x(), tip.z()) - 30e-3;  // above the dome
      EXPECT_GE(height, -1e-9);
      crossed = crossed || std::abs(tip.x()) < 1e-3;
      if (std::abs(tip.x()) < 19e-3) {
        // Between waypoints 1.36 deg apart the dome rises 2.1 um above them.
        EXPECT_GE(height, plan().clearance - 2.2e-6);
      }
    }
  }
  EXPECT_TRUE(crossed);
}

TEST(Waypoints, ALonePointIsCountedAndNotPrinted) {
  WaypointLayer layer = meridian(-5, 5, 0, 5);
  layer.push_back({Vec3(0, 20e-3, 30e-3), Vec3::UnitZ()});
  const WaypointProgram result = plan_waypoints({layer}, plan());
  EXPECT_EQ(result.single_points, 1);
  EXPECT_EQ(result.strokes, 1);
}

TEST(Waypoints, WhatCannotBePrintedIsRefused) {
  const WaypointLayer layer = meridian(-20, 20, 0, 30);
  WaypointPlan p = plan();
  p.tilt_max = 15 * kDegree;
  EXPECT_THAT(
      complaint([&] { plan_waypoints({layer}, p); }),
      HasSubstr("waypoint 1 of layer 1 at (-10.261, 0.000, 28.191) mm tilts the tool 20.000 deg, more "
                "than 15.000 deg"));
  p.files = {"first.txt", "second.txt"};
  EXPECT_THAT(complaint([&] {
                plan_waypoints({meridian(-10, 10, 0, 30), layer}, p);
              }),
              ::testing::StartsWith("second.txt: waypoint 1 of layer 2 at "));
  WaypointLayer low = layer;
  low[3].position.z() = -1e-3;
  EXPECT_THAT(complaint([&] { plan_waypoints({low}, plan()); }), HasSubstr("waypoint 4 of layer 1 at"));
  p = plan();
  p.largest_step = 0.1e-3;
  EXPECT_THAT(complaint([&] { plan_waypoints({layer}, p); }),
              HasSubstr("no two waypoints in a row are within the largest step of 0.1 mm"));
  for (double WaypointPlan::*field :
       {&WaypointPlan::bead_width, &WaypointPlan::bead_height, &WaypointPlan::feed,
        &WaypointPlan::approach_feed, &WaypointPlan::clearance, &WaypointPlan::largest_step,
        &WaypointPlan::tilt_max, &WaypointPlan::filament_diameter}) {
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      p = plan();
      p.*field = bad;
      EXPECT_THAT(complaint([&] { plan_waypoints({layer}, p); }), HasSubstr("must be above 0")) << bad;
    }
  }
}

TEST(Waypoints, PrintsTheBunnysCurvedLayers) {
  const std::filesystem::path folder = UNDERSTUDY_SOURCE_DIR "/../shared/data/curved-layer-waypoints";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const WaypointLayer layer = read_waypoints(folder / "bunny_head_1000S.txt");
  EXPECT_EQ(layer.size(), 915u);  // lines of the file
  std::vector<WaypointLayer> layers = {layer};
  turn(layers, {Vec3::UnitY(), false});
  place_on(layers, Vec3(0, 0, 0.2e-3));
  WaypointPlan p = plan();
  const WaypointProgram result = plan_waypoints(layers, p);
  // Counted in the file: 103 steps above 3 mm, so 104 stretches, some of a single point.
  EXPECT_EQ(result.strokes + result.single_points, 104);
  for (const char* name :
       {"bunny_head_10000S.txt", "bunny_head_10200.txt", "bunny_head_10201.txt", "bunny_head_10202.txt"}) {
    layers = {read_waypoints(folder / name)};
    turn(layers, {Vec3::UnitY(), true});
    place_on(layers, Vec3(0, 0, 0.2e-3));
    EXPECT_GT(plan_waypoints(layers, p).printed, 10e-3) << name;
  }
}

}  // namespace
}  // namespace understudy::toolpath

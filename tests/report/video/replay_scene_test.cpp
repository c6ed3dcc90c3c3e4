#include "report/video/replay_scene.h"

#include <gtest/gtest.h>

namespace understudy::report {
namespace {

/// A stretch along x that is laid with 1 mm/s from 10 s on, in sections 5 s apart.
std::vector<sim::BeadStretch> beads() {
  sim::BeadStretch stretch;
  for (int i = 0; i < 3; ++i)
    stretch.push_back({Vec3(5e-3 * i, 0, 0), Vec3::UnitZ(), 0.4e-3, 0.2e-3, 10. + 5 * i, i + 1});
  return {stretch};
}

/// The tool goes 20 mm along x in 20 s, and extrudes from 10 s on.
RecordedReplay replay() {
  RecordedReplay replay;
  replay.beads = beads();
  for (int i = 0; i <= 20; ++i) {
    rehearsal::TracePoint point;
    point.time = i;
    point.X_WT.translation() = Vec3(1e-3 * i, 0, 0);
    point.extruding = i >= 10;
    replay.path.push_back(point);
  }
  return replay;
}

TEST(ReplayScene, WhatIsLaidEndsWhereTheToolIs) {
  EXPECT_TRUE(laid_by(beads(), 9.9).empty());
  const auto half = laid_by(beads(), 17);
  ASSERT_EQ(half.size(), 1U);
  ASSERT_EQ(half[0].size(), 3U);
  EXPECT_NEAR(half[0].back().middle_W.x(), 7e-3, 1e-12);
  EXPECT_EQ(laid_by(beads(), 15)[0].size(), 2U) << "no section twice";
  EXPECT_EQ(laid_by(beads(), 20)[0].size(), 3U);
}

TEST(ReplayScene, ShowsWhatIsPrintedAndTheRestAsALine) {
  const RecordedReplay record = replay();
  const auto before = replay_scene(record, 5, 1e-5), between = replay_scene(record, 15, 1e-5),
             after = replay_scene(record, 20.5, 1e-5);
  EXPECT_TRUE(before.surfaces.empty());
  EXPECT_EQ(between.surfaces.size(), 1U);
  ASSERT_EQ(before.polylines.size(), 1U);
  EXPECT_EQ(before.polylines[0].points.size(), 11U);
  ASSERT_EQ(between.polylines.size(), 1U);
  EXPECT_EQ(between.polylines[0].points.size(), 6U);
  EXPECT_TRUE(after.polylines.empty());
}

TEST(ReplayScene, TheToolIsBetweenTwoPoints) {
  EXPECT_NEAR(tool_at(replay(), 3.25).translation().x(), 3.25e-3, 1e-12);
  EXPECT_NEAR(tool_at(replay(), 99).translation().x(), 20e-3, 1e-12);
}

}  // namespace
}  // namespace understudy::report

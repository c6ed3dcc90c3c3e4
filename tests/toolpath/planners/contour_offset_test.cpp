#include "toolpath/planners/contour_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::toolpath {
namespace {

constexpr double kGrid = 1e-9;  // coordinates are rounded to it
const auto kEverywhere = [](const Vec2&) { return true; };

Contour rectangle(double x0, double y0, double x1, double y1) {
  return {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
}

double length(const FlatPath& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

/// Of a closed path: positive where it runs counter-clockwise.
double enclosed_area(const FlatPath& path) {
  double twice = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    twice += path[i - 1].x() * path[i].y() - path[i].x() * path[i - 1].y();
  return twice / 2;
}

double distance_to(const std::vector<Contour>& contours, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Contour& c : contours)
    for (std::size_t i = 0; i < c.size(); ++i) {
      const Vec2 a = c[i], along = c[(i + 1) % c.size()] - a;
      const double s = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + s * along - p).norm());
    }
  return nearest;
}

TEST(ContourOffset, ARectangleShrinksByTheOffsetOnEverySide) {
  const auto paths = inset_paths({rectangle(0, 0, 10e-3, 6e-3)}, 1e-3, 0, kEverywhere);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].front(), paths[0].back());
  EXPECT_LE((paths[0].front() - Vec2(1e-3, 1e-3)).norm(), kGrid) << "it begins by the contour's first point";
  EXPECT_NEAR(length(paths[0]), 2 * (8e-3 + 4e-3), 8 * kGrid);
  EXPECT_NEAR(enclosed_area(paths[0]), 8e-3 * 4e-3, 24e-3 * kGrid);
}

TEST(ContourOffset, AHoleGrowsAndKeepsItsDirection) {
  Contour hole = rectangle(4e-3, 4e-3, 6e-3, 6e-3);
  std::reverse(hole.begin(), hole.end());
  const auto paths = inset_paths({rectangle(0, 0, 10e-3, 10e-3), hole}, 1e-3, 0, kEverywhere);
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_NEAR(enclosed_area(paths[0]), 8e-3 * 8e-3, 32e-3 * kGrid);
  EXPECT_NEAR(enclosed_area(paths[1]), -4e-3 * 4e-3, 16e-3 * kGrid);
}

TEST(ContourOffset, WallAndHoleThatMeetGiveOneLoopEachSide) {
  // A hole that leaves 1 mm of wall above and below: insets of 0.6 mm pass to its left and right only.
  Contour hole = rectangle(4e-3, 1e-3, 6e-3, 9e-3);
  std::reverse(hole.begin(), hole.end());
  const std::vector<Contour> section = {rectangle(0, 0, 10e-3, 10e-3), hole};
  const auto paths = inset_paths(section, 0.6e-3, 0, kEverywhere);
  ASSERT_EQ(paths.size(), 2u);
  for (const FlatPath& path : paths) {
    EXPECT_EQ(path.front(), path.back());
    EXPECT_NEAR(enclosed_area(path), 2.8e-3 * 8.8e-3, 24e-3 * kGrid);
  }
}

TEST(ContourOffset, NothingIsLeftWhereTheSectionIsNarrowerThanTwoOffsets) {
  const std::vector<Contour> slot = {rectangle(0, 0, 10e-3, 0.8e-3)};
  EXPECT_EQ(inset_paths(slot, 0.3e-3, 0, kEverywhere).size(), 1u);
  EXPECT_TRUE(inset_paths(slot, 0.5e-3, 0, kEverywhere).empty());
  // A dumb-bell: the offset runs in both ends, not through the neck of 1 mm.
  const std::vector<Contour> dumbbell = {{Vec2(0, 0), Vec2(4e-3, 0), Vec2(4e-3, 1.5e-3), Vec2(8e-3, 1.5e-3),
                                          Vec2(8e-3, 0), Vec2(12e-3, 0), Vec2(12e-3, 4e-3), Vec2(8e-3, 4e-3),
                                          Vec2(8e-3, 2.5e-3), Vec2(4e-3, 2.5e-3), Vec2(4e-3, 4e-3),
                                          Vec2(0, 4e-3)}};
  const auto paths = inset_paths(dumbbell, 0.6e-3, 0, kEverywhere);
  EXPECT_EQ(paths.size(), 2u);
  for (const FlatPath& path : paths)
    for (const Vec2& p : path) EXPECT_GT(distance_to(dumbbell, p), 0.6e-3 - 2 * kGrid);
}

TEST(ContourOffset, PathsStopWhereTheyAreNotWanted) {
  const auto left_half = [](const Vec2& p) { return p.x() < 5e-3; };
  const auto paths = inset_paths({rectangle(0, 0, 10e-3, 6e-3)}, 1e-3, 0, left_half);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_NEAR(length(paths[0]), 4e-3 + 2 * 4e-3, 2e-6);
  EXPECT_NEAR(paths[0].front().x(), 5e-3, 1e-6);
  EXPECT_NEAR(paths[0].back().x(), 5e-3, 1e-6);
  EXPECT_TRUE(inset_paths({rectangle(0, 0, 10e-3, 6e-3)}, 1e-3, 13e-3, left_half).empty());
}

TEST(ContourOffset, InsetsOfRandomStarsKeepTheirDistance) {
  Random random(11, "contour offsets");
  for (int n = 0; n < 200; ++n) {
    Contour star;
    for (int k = 0; k < 24; ++k) {
      const double radius = random.uniform(4e-3, 10e-3), angle = 2 * std::numbers::pi * k / 24;
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    const double offset = random.uniform(0.1e-3, 2e-3);
    for (const FlatPath& path : inset_paths({star}, offset, 0, kEverywhere))
      for (const Vec2& p : path) ASSERT_GT(distance_to({star}, p), offset - 5 * kGrid) << "star " << n;
  }
}

TEST(ContourOffset, SimplifiedLosesPointsOnAStraightSideAndDoubledOnes) {
  const Contour square = {Vec2(0, 0),        Vec2(5e-3, 0.2e-6), Vec2(10e-3, 0), Vec2(10e-3, 0.1e-6),
                          Vec2(10e-3, 5e-3), Vec2(10e-3, 10e-3), Vec2(0, 10e-3)};
  const Contour kept = simplified(square, 1e-6);
  EXPECT_EQ(kept.size(), 4u);
  EXPECT_EQ(simplified(kept, 1e-6).size(), 4u);
}

}  // namespace
}  // namespace understudy::toolpath
